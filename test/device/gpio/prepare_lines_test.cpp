// SPDX-License-Identifier: Apache-2.0
// The difference of two wirings, on chips that this test makes: it has a backend of its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "coupler/device/gpio/backend.hpp"
#include "coupler/device/gpio/line_requests.hpp"
#include "test/device/core/fake_log.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::device {
namespace {

using fakes::MapBuilder;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The machine: chips, who holds which line, and what was done to each wire.
struct Machine {
  std::vector<Chip> chips{{"/dev/gpiochip0", "gpiochip0", "plant", std::vector<std::string>(8)}};
  std::set<std::pair<std::string, unsigned>> held;
  std::map<unsigned, int> levels;    ///< by offset, of outputs that were driven
  std::vector<std::string> history;  ///< "take 0 1", "drive 0 1", "release 0"
  std::set<std::string> gone;        ///< chips whose lines are not there any more
  std::set<unsigned> refused;        ///< offsets that cannot be requested
};
Machine machine;

class FakeLines {
 public:
  explicit FakeLines(const std::vector<LineSpec>& lines) : name_(names_of(lines)) {
    for (const LineSpec& line : lines) lines_.emplace_back(line.line.chip->name, line.line.offset);
    machine.held.insert(lines_.begin(), lines_.end());
  }
  FakeLines(const FakeLines&) = delete;
  FakeLines& operator=(const FakeLines&) = delete;
  ~FakeLines() {
    for (const auto& line : lines_) {
      machine.held.erase(line);
      machine.history.push_back("release " + std::to_string(line.second));
    }
  }
  const std::string& name() const { return name_; }
  bool is_plugged() const { return machine.gone.count(lines_.front().first) == 0; }
  unsigned offset(std::size_t i) const { return lines_[i].second; }

 private:
  std::string name_;
  std::vector<std::pair<std::string, unsigned>> lines_;
};

class FakeOutputs : public OutputGroup {
 public:
  explicit FakeOutputs(const std::vector<LineSpec>& lines) : lines_(lines) {
    for (const LineSpec& line : lines) put("take", line.line.offset, line.level);
  }
  const std::string& name() const override { return lines_.name(); }
  bool is_plugged() override { return lines_.is_plugged(); }
  int drive(Span<const int> levels) override {
    for (std::size_t i = 0; i < levels.size(); ++i)
      if (machine.levels[lines_.offset(i)] != levels[i]) put("drive", lines_.offset(i), levels[i]);
    return 0;
  }
  int read(Span<int>) override { return 0; }

 private:
  static void put(const std::string& what, unsigned offset, int level) {
    machine.levels[offset] = level;
    machine.history.push_back(what + " " + std::to_string(offset) + " " + std::to_string(level));
  }
  FakeLines lines_;
};

class FakeInputs : public InputGroup {
 public:
  explicit FakeInputs(const std::vector<LineSpec>& lines) : lines_(lines) {
    for (const LineSpec& line : lines) machine.history.push_back("take " + std::to_string(line.line.offset));
  }
  const std::string& name() const override { return lines_.name(); }
  bool is_plugged() override { return lines_.is_plugged(); }
  int read(Span<int> levels, TimePoint) override {
    std::fill(levels.begin(), levels.end(), 1);
    return 0;
  }

 private:
  FakeLines lines_;
};

bool is_free(const std::vector<LineSpec>& lines) {
  return std::none_of(lines.begin(), lines.end(), [](const LineSpec& line) {
    return machine.refused.count(line.line.offset) != 0 ||
           machine.held.count({line.line.chip->name, line.line.offset}) != 0;
  });
}

}  // namespace

namespace backend {

Inventory chips() { return Inventory(machine.chips); }

bool fits(const std::vector<LineSpec>& group, const LineSpec& line) {
  return is_output(group.front()) == is_output(line) &&
         group.front().point->line.active_low == line.point->line.active_low;
}

tl::expected<std::unique_ptr<OutputGroup>, std::string> request_outputs(const std::vector<LineSpec>& lines) {
  if (!is_free(lines)) return tl::unexpected("busy: " + names_of(lines));
  return std::make_unique<FakeOutputs>(lines);
}

tl::expected<std::unique_ptr<InputGroup>, std::string> request_inputs(const std::vector<LineSpec>& lines) {
  if (!is_free(lines)) return tl::unexpected("busy: " + names_of(lines));
  return std::make_unique<FakeInputs>(lines);
}

}  // namespace backend

namespace {

auto at(unsigned offset, Safe safe = Safe::off, bool active_low = false) {
  return [=](Point& p) {
    p.line.chip = "plant";
    p.line.offset = offset;
    p.line.active_low = active_low;
    p.safe = safe;
  };
}

/// A node whose map is changed.
class Wires : public testing::Test {
 protected:
  Wires() { machine = Machine(); }

  /// The error; empty: it is in force.
  std::string change_to(const MapBuilder& builder, bool safe = false) {
    const MapPtr map = builder.build();
    auto next = LineRequests::prepare(map->map(), wiring(), safe, log_);
    if (!next) return next.error();
    machine.history.push_back("prepared");
    auto taken = (*next)->take_over();
    owner_ = map;
    wiring_ = std::move(taken);
    return "";
  }
  LineRequests* wiring() { return static_cast<LineRequests*>(wiring_.get()); }
  bool write(std::uint16_t coil, std::uint16_t level) {
    return wiring_->lines().drive(modbus::Range::of(coil, 1), Span<const std::uint16_t>(&level, 1));
  }
  std::vector<std::string> news() { return std::exchange(machine.history, {}); }

  static MapBuilder two_lamps() {
    return MapBuilder()
        .add(Table::coils, "a", 0, codec::Type::BOOL, at(0))
        .add(Table::coils, "b", 1, codec::Type::BOOL, at(1, Safe::on));
  }

  FakeLog log_;
  MapPtr owner_;
  std::unique_ptr<Wiring> wiring_;
};

TEST_F(Wires, The_same_map_again_touches_nothing) {
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_TRUE(write(0, 1));
  news();
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_THAT(news(), ElementsAre("prepared"));
  std::uint16_t level = 0;
  EXPECT_TRUE(wiring_->lines().driven(modbus::Range::of(0, 1), Span<std::uint16_t>(&level, 1)));
  EXPECT_EQ(level, 1);
}

TEST_F(Wires, A_new_line_is_requested_first_and_a_line_that_leaves_alone_is_released_in_its_safe_state) {
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(0, Safe::on))), "");
  news();
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "b", 0, codec::Type::BOOL, at(1))), "");
  EXPECT_THAT(news(), ElementsAre("take 1 0", "prepared", "drive 0 1", "release 0"));
  EXPECT_THAT(log_.lines, IsEmpty());
}

TEST_F(Wires, A_line_that_leaves_others_behind_stays_held_safe_and_can_come_back) {
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_TRUE(write(0, 1));
  news();
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 5, codec::Type::BOOL, at(0))), "");
  EXPECT_THAT(news(), ElementsAre("prepared", "drive 1 1"));
  EXPECT_THAT(log_.lines,
              ElementsAre(HasSubstr("gpiochip0 line 1 is not in the map any more, but stays held")));
  EXPECT_TRUE(write(5, 0)) << "its new address";
  EXPECT_TRUE(write(5, 1));
  EXPECT_TRUE(wiring_->lines().drive_safe());
  news();
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_THAT(news(), ElementsAre("prepared", "drive 1 0")) << "to its initial level";
}

TEST_F(Wires, After_the_watchdog_new_outputs_begin_safe) {
  const auto initially_on = [](unsigned offset, Safe safe) {
    return [=](Point& p) {
      static constexpr std::uint16_t on = 1;
      at(offset, safe)(p);
      p.initial = Span<const std::uint16_t>(&on, 1);
    };
  };
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(0))), "");
  EXPECT_EQ(machine.levels[1], 1) << "idle, and safe";
  news();
  EXPECT_EQ(change_to(two_lamps()
                          .add(Table::coils, "c", 2, codec::Type::BOOL, initially_on(2, Safe::off))
                          .add(Table::coils, "d", 3, codec::Type::BOOL, initially_on(3, Safe::hold))
                          .add(Table::coils, "e", 4, codec::Type::BOOL, at(4, Safe::on)),
                      true),
            "");
  EXPECT_THAT(news(), ElementsAre("take 2 0", "take 3 1", "take 4 1", "prepared"));
}

TEST_F(Wires, After_the_watchdog_an_output_that_moves_to_another_line_begins_safe_there) {
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(0))), "");
  news();
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(1, Safe::on)), true), "");
  EXPECT_THAT(news(), ElementsAre("take 1 1", "prepared", "release 0"));
}

TEST_F(Wires, What_cannot_be_had_leaves_everything_as_it_is) {
  EXPECT_EQ(change_to(two_lamps()), "");
  news();
  machine.refused = {3};
  EXPECT_THAT(change_to(two_lamps()
                            .add(Table::coils, "c", 2, codec::Type::BOOL, at(2, Safe::off, true))
                            .add(Table::discrete_inputs, "d", 0, codec::Type::BOOL, at(3))),
              HasSubstr("busy: gpiochip0 line 3"));
  EXPECT_THAT(news(), ElementsAre("take 2 0", "release 2"));
  EXPECT_TRUE(write(1, 1)) << "the old wiring works";
}

TEST_F(Wires, The_settings_of_an_output_change_only_without_others_beside_it) {
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_THAT(change_to(MapBuilder()
                            .add(Table::coils, "a", 0, codec::Type::BOOL, at(0, Safe::off, true))
                            .add(Table::coils, "b", 1, codec::Type::BOOL, at(1))),
              AllOf(HasSubstr("point 'a'"), HasSubstr("restart the node")));
  news();
  EXPECT_EQ(change_to(MapBuilder()
                          .add(Table::coils, "a", 0, codec::Type::BOOL, at(0, Safe::off, true))
                          .add(Table::coils, "b", 1, codec::Type::BOOL, at(1, Safe::off, true))),
            "");
  EXPECT_THAT(news(), ElementsAre("prepared", "drive 1 1", "release 0", "release 1", "take 0 0", "take 1 0"));
}

TEST_F(Wires, Inputs_are_requested_anew_if_one_of_their_request_changes) {
  const auto inputs = [](bool low) {
    return MapBuilder()
        .add(Table::discrete_inputs, "x", 0, codec::Type::BOOL, at(4))
        .add(Table::discrete_inputs, "y", 1, codec::Type::BOOL, at(5, Safe::off, low));
  };
  EXPECT_EQ(change_to(inputs(false)), "");
  news();
  EXPECT_EQ(change_to(inputs(true)), "");
  EXPECT_THAT(news(), ElementsAre("prepared", "release 4", "release 5", "take 4", "take 5"));
}

TEST_F(Wires, A_line_that_changes_sides_is_safe_and_released_before) {
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(0, Safe::on))), "");
  news();
  EXPECT_EQ(change_to(MapBuilder().add(Table::discrete_inputs, "a", 0, codec::Type::BOOL, at(0))), "");
  EXPECT_THAT(news(), ElementsAre("prepared", "drive 0 1", "release 0", "take 0"));
}

TEST_F(Wires, What_the_kernel_takes_back_only_later_is_told_and_tried_again) {
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(0))), "");
  machine.refused = {0};
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(0, Safe::off, true))), "");
  EXPECT_THAT(log_.lines, Contains(HasSubstr("busy: gpiochip0 line 0")));
  EXPECT_FALSE(write(0, 1));
  machine.refused.clear();
  EXPECT_TRUE(wiring_->reconnect(false));
  EXPECT_TRUE(write(0, 1));
}

TEST_F(Wires, A_chip_that_comes_back_has_its_outputs_driven_as_before_wherever_it_is) {
  EXPECT_EQ(change_to(two_lamps().add(Table::discrete_inputs, "x", 0, codec::Type::BOOL, at(4))), "");
  EXPECT_TRUE(write(0, 1));
  EXPECT_FALSE(wiring_->reconnect(false)) << "all is well";
  news();
  log_.lines.clear();

  machine.gone = {"gpiochip0"};
  const std::vector<Chip> chips = std::exchange(machine.chips, {});
  EXPECT_TRUE(wiring_->reconnect(false));
  EXPECT_TRUE(machine.held.empty());
  EXPECT_FALSE(write(0, 0));
  std::uint16_t level = 0;
  EXPECT_FALSE(wiring_->lines().read(modbus::Range::of(0, 1), Span<std::uint16_t>(&level, 1), {}));
  EXPECT_FALSE(wiring_->reconnect(false)) << "nothing new";
  EXPECT_THAT(log_.lines,
              ElementsAre(HasSubstr("failed: No such device"), HasSubstr("failed: No such device")));

  machine.chips = chips;
  machine.chips[0].name = "gpiochip3";
  news();
  EXPECT_TRUE(wiring_->reconnect(false));
  EXPECT_THAT(news(), ElementsAre("take 0 1", "take 1 0", "take 4"));
  EXPECT_TRUE(write(0, 0));
  EXPECT_TRUE(wiring_->lines().read(modbus::Range::of(0, 1), Span<std::uint16_t>(&level, 1), {}));
  EXPECT_THAT(log_.lines, Contains(HasSubstr("gpiochip3 line 0, gpiochip3 line 1 works again")));
}

TEST_F(Wires, After_the_watchdog_it_comes_back_safe) {
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_TRUE(write(0, 1));
  machine.gone = {"gpiochip0"};
  const std::vector<Chip> chips = std::exchange(machine.chips, {});
  EXPECT_TRUE(wiring_->reconnect(true));
  machine.chips = chips;
  machine.gone.clear();
  news();
  EXPECT_TRUE(wiring_->reconnect(true));
  EXPECT_THAT(news(), ElementsAre("take 0 0", "take 1 1"));
}

TEST_F(Wires, A_safe_state_that_an_unplugged_chip_missed_is_what_it_comes_back_with) {
  EXPECT_EQ(change_to(two_lamps()), "");
  EXPECT_TRUE(write(0, 1));
  machine.gone = {"gpiochip0"};
  const std::vector<Chip> chips = std::exchange(machine.chips, {});
  EXPECT_TRUE(wiring_->reconnect(false));
  EXPECT_FALSE(wiring_->lines().drive_safe());
  machine.chips = chips;
  machine.gone.clear();
  news();
  EXPECT_TRUE(wiring_->reconnect(false)) << "the watchdog may be idle, or fed again, by now";
  EXPECT_THAT(news(), ElementsAre("take 0 0", "take 1 1"));
}

TEST_F(Wires, Outputs_that_are_to_be_held_are_safe_on_an_unplugged_chip_too) {
  EXPECT_EQ(change_to(MapBuilder().add(Table::coils, "a", 0, codec::Type::BOOL, at(0, Safe::hold))), "");
  machine.gone = {"gpiochip0"};
  machine.chips.clear();
  EXPECT_TRUE(wiring_->reconnect(false));
  EXPECT_TRUE(wiring_->lines().drive_safe());
  EXPECT_THAT(log_.lines, ElementsAre(HasSubstr("failed: No such device")));
}

}  // namespace
}  // namespace coupler::device
