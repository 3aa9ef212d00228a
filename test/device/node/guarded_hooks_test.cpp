// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

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
    return registers[0] != 13;
  }
  void serving_began() override { throw 7; }
  void make_safe() override {
    EXPECT_TRUE(set<std::int16_t>(0, 5).has_value());
    if (!is_calm) throw std::runtime_error("the motor does not answer");
  }

  bool is_calm = false;
};

class Guarded : public testing::Test {
 protected:
  bool accept(std::uint16_t value) { return guarded_.accept(0, &value); }

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

}  // namespace
}  // namespace coupler::device
