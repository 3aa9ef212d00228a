// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "coupler/device/node/guarded_hooks.hpp"
#include "coupler/device/node/point_hooks.hpp"
#include "coupler/map/image_layout.hpp"
#include "test/device/core/fake_log.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::device {
namespace {

using codec::Type;
using fakes::MapBuilder;
using testing::ElementsAre;

/// Throws in whatever is called; make_safe() only unless it is calm.
class Throwing : public PointHooks {
 public:
  explicit Throwing(const Map& map) : PointHooks(map) {}
  bool accept(std::uint32_t, const std::uint16_t* registers) override {
    if (registers[0] > 100) throw std::out_of_range("too fast");
    if (registers[0] == 14) return refuse("14 is taken");
    if (registers[0] == 15) {
      (void)refuse("15 is taken");
      throw std::out_of_range("and lost");
    }
    return registers[0] != 13;
  }
  bool answers() override {
    if (mood == Mood::throws) throw std::runtime_error("no plan");
    return mood == Mood::agrees;
  }
  std::optional<modbus::Exception> refuse_read(Table table, modbus::Range range) override {
    EXPECT_EQ(table, Table::holding_registers);
    EXPECT_EQ(range, modbus::Range::of(3, 2));
    if (mood == Mood::throws) throw std::runtime_error("no sensor");
    if (mood == Mood::agrees) return std::nullopt;
    return modbus::Exception::server_device_busy;
  }
  void serving_began() override { throw 7; }
  void make_safe() override {
    EXPECT_TRUE(set<std::int16_t>(0, 5).has_value());
    if (!is_calm) throw std::runtime_error("the motor does not answer");
  }

  bool is_calm = false;
  enum class Mood { agrees, refuses, throws } mood = Mood::agrees;  ///< towards clients
};

class Guarded : public testing::Test {
 protected:
  using Mood = Throwing::Mood;
  bool accept(std::uint16_t value) { return guarded_.accept(0, &value); }
  std::optional<modbus::Exception> refuse_read() {
    return guarded_.refuse_read(Table::holding_registers, modbus::Range::of(3, 2));
  }

  MapPtr map_ = MapBuilder().add(Table::holding_registers, "speed", 0, Type::INT).build();
  Throwing hooks_{map_->map()};
  FakeLog log_;
  GuardedHooks guarded_{hooks_, map_->map(), log_};
};

TEST_F(Guarded, A_hook_that_throws_refuses_and_is_told) {
  EXPECT_TRUE(accept(12));
  EXPECT_FALSE(accept(13));
  EXPECT_THAT(log_.lines, testing::IsEmpty());
  EXPECT_FALSE(accept(101));
  EXPECT_THAT(log_.lines,
              ElementsAre("the hook of point 'speed' threw an exception: too fast; the write is refused"));
}

TEST_F(Guarded, The_reason_of_a_refusal_is_told_once) {
  EXPECT_FALSE(accept(14));
  EXPECT_THAT(log_.lines, ElementsAre("a write of point 'speed' is refused: 14 is taken"));
  EXPECT_FALSE(accept(13));
  EXPECT_EQ(log_.lines.size(), 1U);
}

TEST_F(Guarded, The_reason_that_a_hook_gave_before_it_threw_is_not_that_of_the_next_refusal) {
  EXPECT_FALSE(accept(15));
  EXPECT_THAT(log_.lines,
              ElementsAre("the hook of point 'speed' threw an exception: and lost; the write is refused"));
  EXPECT_FALSE(accept(13));
  EXPECT_EQ(log_.lines.size(), 1U);
}

TEST_F(Guarded, What_is_asked_about_reads_is_passed_on_and_a_hook_that_throws_is_a_failed_device) {
  EXPECT_EQ(refuse_read(), std::nullopt);
  hooks_.mood = Mood::refuses;
  EXPECT_EQ(refuse_read(), modbus::Exception::server_device_busy);
  EXPECT_THAT(log_.lines, testing::IsEmpty());
  hooks_.mood = Mood::throws;
  EXPECT_EQ(refuse_read(), modbus::Exception::server_device_failure);
  EXPECT_THAT(log_.lines, ElementsAre("refuse_read() threw an exception: no sensor"));
}

TEST_F(Guarded, Whether_it_answers_is_passed_on_and_a_hook_that_throws_answers) {
  EXPECT_TRUE(guarded_.answers());
  hooks_.mood = Mood::refuses;
  EXPECT_FALSE(guarded_.answers());
  EXPECT_THAT(log_.lines, testing::IsEmpty());
  hooks_.mood = Mood::throws;
  EXPECT_TRUE(guarded_.answers());
  EXPECT_THAT(log_.lines, ElementsAre("answers() threw an exception: no plan"));
}

TEST_F(Guarded, A_process_whose_firmware_cannot_begin_does_not_serve) {
  EXPECT_FALSE(guarded_.begin(nullptr));
  EXPECT_THAT(log_.lines,
              ElementsAre("serving_began() threw an exception: something that is not a std::exception"));
}

TEST_F(Guarded, At_the_end_what_make_safe_sets_is_in_the_image) {
  const NodeMemory size = node_memory(map_->map());
  std::vector<Image::Area> areas(size.areas);
  std::vector<std::uint16_t> cells(size.cells);
  Image image(map_->map(), areas, cells);
  EXPECT_FALSE(guarded_.end(image));
  EXPECT_THAT(log_.lines, ElementsAre("make_safe() threw an exception: the motor does not answer"));
  hooks_.is_calm = true;
  EXPECT_TRUE(guarded_.end(image));
  EXPECT_EQ(image.find(Table::holding_registers, modbus::Range::of(0, 1))[0], 5);
}

/// set() of generated hooks.
class Settable : public PointHooks {
 public:
  explicit Settable(const Map& map) : PointHooks(map) {}
  auto set_speed(std::int16_t value) { return set<std::int16_t>(0, value); }
  auto set_lamp(bool on) { return set<bool>(0, on); }
  auto set_lamps(const std::array<bool, 3>& on) { return set<std::array<bool, 3>>(0, on); }
  void replace_lamp(bool on) {
    const std::uint16_t bit = on ? 1 : 0;
    replace_registers(0, &bit);
  }
};

TEST(PointHooks, A_value_is_set_in_the_process_that_serves_and_nowhere_else) {
  const MapPtr map = MapBuilder().add(Table::holding_registers, "speed", 0, Type::INT).build();
  Settable hooks(map->map());
  const auto before = hooks.set_speed(5);
  ASSERT_FALSE(before.has_value());
  EXPECT_THAT(before.error(), testing::HasSubstr("this process does not answer clients"));
  hooks.allow_setting(nullptr);
  EXPECT_TRUE(hooks.set_speed(5).has_value());
}

/// Where the values go that such hooks set.
struct Taken {
  explicit Taken(MapPtr of) : owner(std::move(of)) {
    changes.begin(1);
    hooks.allow_setting(nullptr);
  }
  void put() { hooks.put_new_values(image, changes); }

  MapPtr owner;
  NodeMemory size = node_memory(owner->map());
  std::vector<Image::Area> areas = std::vector<Image::Area>(size.areas);
  std::vector<std::uint16_t> cells = std::vector<std::uint16_t>(size.cells);
  Image image{owner->map(), areas, cells};
  std::vector<ChangeRing::Entry> ring = std::vector<ChangeRing::Entry>(200);
  std::vector<std::uint16_t> told = std::vector<std::uint16_t>(image.bits().size());
  Changes changes{image, ring, told};
  Settable hooks{owner->map()};
};

TEST(PointHooks, Each_value_of_a_bit_is_told_or_counted_as_lost) {
  Taken node(MapBuilder().coil("lamp", 0).build());
  for (const bool on : {true, false, true, false}) ASSERT_TRUE(node.hooks.set_lamp(on));
  node.put();
  EXPECT_EQ(node.changes.ring().newest(), 4U);
  // Where nobody takes them, they do not become more and more, and the last one counts.
  for (int i = 0; i < 1001; ++i) ASSERT_TRUE(node.hooks.set_lamp(i % 2 == 0));
  node.put();
  EXPECT_EQ(node.changes.ring().newest(), 4U + 1001U);  // told, or counted as lost
  int heard = 0;
  for (const auto* entry = node.changes.ring().next_after(4); entry != nullptr;
       entry = node.changes.ring().next_after(entry->number))
    ++heard;
  EXPECT_EQ(heard, 15);  // the last two of sixteen values are equal
  EXPECT_EQ(node.image.find(Table::coils, modbus::Range::of(0, 1))[0], 1);
}

TEST(PointHooks, So_is_each_value_of_each_bit_of_an_array) {
  Taken node(
      MapBuilder().add(Table::coils, "lamps", 0, Type::BOOL, [](Point& point) { point.count = 3; }).build());
  // One toggles, one changes once, the third never.
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(node.hooks.set_lamps({i % 2 == 0, i >= 50, false}));
  node.put();
  EXPECT_EQ(node.changes.ring().newest(), 100U + 1U);
}

TEST(PointHooks, What_takes_the_place_of_others_leaves_none_of_them) {
  Taken node(MapBuilder().coil("lamp", 0).build());
  for (int i = 0; i < 1001; ++i) ASSERT_TRUE(node.hooks.set_lamp(i % 2 == 0));
  node.hooks.replace_lamp(true);
  node.put();
  EXPECT_EQ(node.changes.ring().newest(), 1U);
}

}  // namespace
}  // namespace coupler::device
