// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <optional>
#include <tuple>
#include <utility>

#include "coupler/device/gpio/grouped_lines.hpp"
#include "coupler/device/gpio/line_edges.hpp"
#include "test/device/core/fake_log.hpp"

namespace coupler::device {
namespace {

using modbus::Range;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Levels = std::vector<std::uint16_t>;

/// A chip's lines as the test sees them.
struct Hardware {
  std::vector<int> levels;
  int error = 0;
  int calls = 0;
  std::optional<std::size_t> stuck = std::nullopt;  ///< this line stays where it is
};

class FakeOutputs : public OutputGroup {
 public:
  FakeOutputs(std::string name, Hardware& hardware) : name_(std::move(name)), hardware_(hardware) {}
  const std::string& name() const override { return name_; }
  int drive(Span<const int> levels) override {
    ++hardware_.calls;
    if (hardware_.error != 0) return hardware_.error;
    for (std::size_t i = 0; i < levels.size(); ++i)
      if (i != hardware_.stuck) hardware_.levels[i] = levels[i];
    return 0;
  }
  int read(Span<int> levels) override {
    std::copy(hardware_.levels.begin(), hardware_.levels.end(), levels.begin());
    return hardware_.error;
  }

 private:
  std::string name_;
  Hardware& hardware_;
};

class FakeInputs : public InputGroup {
 public:
  explicit FakeInputs(Hardware& hardware) : hardware_(hardware) {}
  const std::string& name() const override { return name_; }
  int read(Span<int> levels, TimePoint) override {
    std::copy(hardware_.levels.begin(), hardware_.levels.end(), levels.begin());
    return hardware_.error;
  }

 private:
  std::string name_ = "chip2 line 0";
  Hardware& hardware_;
};

/// Coils 0, 2, 10 on one chip, 1 and 11 on another; discrete inputs 4 and 6 on a third.
class Grouped : public testing::Test {
 protected:
  GroupedLines make() {
    std::vector<WiredOutputs> outputs;
    outputs.push_back({std::make_unique<FakeOutputs>("chip0", first_),
                       {{0, Safe::off, 0}, {2, Safe::on, 0}, {10, Safe::hold, 1}}});
    outputs.push_back(
        {std::make_unique<FakeOutputs>("chip1", second_), {{1, Safe::on, 0}, {11, Safe::on, 0}}});
    std::vector<WiredInputs> inputs;
    inputs.push_back({std::make_unique<FakeInputs>(third_), {4, 6}});
    return GroupedLines(std::move(outputs), std::move(inputs), log_);
  }

  Hardware first_{{0, 0, 1}};
  Hardware second_{{0, 0}};
  Hardware third_{{0, 1}};
  FakeLog log_;
  GroupedLines lines_ = make();
};

/// Coils 0 and 1 on one chip, 2 and 3 on another, compared after each write.
class ReadBack : public testing::Test {
 protected:
  GroupedLines make() {
    std::vector<WiredOutputs> outputs;
    outputs.push_back(
        {std::make_unique<FakeOutputs>("chip0", first_), {{0, Safe::off, 0}, {1, Safe::on, 0}}, true});
    outputs.push_back(
        {std::make_unique<FakeOutputs>("chip1", second_), {{2, Safe::off, 0}, {3, Safe::on, 0}}, true});
    return GroupedLines(std::move(outputs), {}, log_);
  }

  Hardware first_{{0, 0}};
  Hardware second_{{0, 0}};
  FakeLog log_;
  GroupedLines lines_ = make();
};

TEST_F(Grouped, Each_for_itself_one_chip_that_fails_keeps_no_other_from_its_levels) {
  first_.error = EIO;
  EXPECT_FALSE(lines_.drive_each(Range::of(0, 12), Levels(12, 1)));
  EXPECT_THAT(first_.levels, ElementsAre(0, 0, 1));
  EXPECT_THAT(second_.levels, ElementsAre(1, 1));
  Levels driven(12);
  lines_.driven(Range::of(0, 12), driven);
  EXPECT_THAT(driven, ElementsAre(0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1));
  first_.error = 0;
  EXPECT_TRUE(lines_.drive_each(Range::of(0, 1), Levels{1}));
  EXPECT_THAT(first_.levels, ElementsAre(1, 0, 1));
}

TEST_F(Grouped, Each_for_itself_a_chip_that_is_unplugged_has_its_levels_when_it_is_plugged_in_again) {
  lines_.lose_outputs(0);
  EXPECT_TRUE(lines_.drive_each(Range::of(0, 3), Levels{1, 1, 1}));
  Levels driven(3);
  lines_.driven(Range::of(0, 3), driven);
  EXPECT_THAT(driven, ElementsAre(1, 1, 1)) << "LineRequests requests it so";
  EXPECT_FALSE(lines_.drive(Range::of(0, 3), Levels{0, 0, 0})) << "a write is refused all the same";
}

TEST_F(ReadBack, A_line_that_does_not_follow_fails_the_write_and_the_others_go_back) {
  second_.stuck = 1;
  EXPECT_FALSE(lines_.drive(Range::of(0, 4), Levels{1, 1, 1, 1}));
  EXPECT_THAT(first_.levels, ElementsAre(0, 0));
  EXPECT_THAT(second_.levels, ElementsAre(0, 0));
  EXPECT_FALSE(lines_.drive(Range::of(3, 1), Levels{1}));
  EXPECT_THAT(log_.lines, ElementsAre(HasSubstr("chip1"))) << "said once";
  EXPECT_TRUE(lines_.drive(Range::of(0, 3), Levels{1, 1, 1})) << "the stuck line is where it should be";
}

TEST_F(ReadBack, Lines_that_follow_are_driven_once) {
  EXPECT_TRUE(lines_.drive(Range::of(0, 2), Levels{1, 1}));
  EXPECT_EQ(first_.calls, 1);
  EXPECT_THAT(first_.levels, ElementsAre(1, 1));
}

TEST_F(ReadBack, A_safe_state_that_is_not_reached_is_no_success) {
  first_.stuck = 1;
  EXPECT_FALSE(lines_.drive_safe());
  EXPECT_THAT(second_.levels, ElementsAre(0, 1));
}

TEST_F(Grouped, A_write_drives_each_chip_it_needs_once_and_leaves_the_other_lines_as_they_are) {
  EXPECT_TRUE(lines_.drive(Range::of(0, 3), Levels{1, 1, 1}));
  EXPECT_THAT(first_.levels, ElementsAre(1, 1, 1));
  EXPECT_THAT(second_.levels, ElementsAre(1, 0));
  EXPECT_EQ(first_.calls, 1);
  EXPECT_EQ(second_.calls, 1);
  EXPECT_TRUE(lines_.drive(Range::of(11, 1), Levels{1}));
  EXPECT_EQ(first_.calls, 1);
  EXPECT_THAT(second_.levels, ElementsAre(1, 1));
}

TEST_F(Grouped, Coils_without_a_line_need_no_hardware) {
  first_.error = second_.error = EIO;
  EXPECT_TRUE(lines_.drive(Range::of(3, 7), Levels(7, 1)));
}

TEST_F(Grouped, When_one_chip_refuses_the_others_go_back) {
  second_.error = EIO;
  EXPECT_FALSE(lines_.drive(Range::of(0, 2), Levels{1, 1}));
  EXPECT_THAT(first_.levels, ElementsAre(0, 0, 1));
  EXPECT_THAT(second_.levels, ElementsAre(0, 0));
  second_.error = 0;
  EXPECT_TRUE(lines_.drive(Range::of(11, 1), Levels{1}));
  EXPECT_THAT(second_.levels, ElementsAre(0, 1)) << "nothing of the refused write is left over";
}

TEST_F(Grouped, A_read_brings_the_levels_of_the_lines_in_the_range) {
  Levels levels{7, 7, 7};
  EXPECT_TRUE(lines_.read(Range::of(5, 3), levels, {}));
  EXPECT_THAT(levels, ElementsAre(7, 1, 7)) << "addresses without a line are left alone";
  third_.error = ENODEV;
  EXPECT_FALSE(lines_.read(Range::of(6, 1), levels, {}));
  EXPECT_TRUE(lines_.read(Range::of(7, 3), levels, {})) << "none of these has a line";
}

TEST_F(Grouped, The_safe_state_holds_what_is_to_be_held_and_tries_every_chip) {
  EXPECT_TRUE(lines_.drive(Range::of(0, 1), Levels{1}));
  first_.error = EIO;
  EXPECT_FALSE(lines_.drive_safe());
  EXPECT_THAT(second_.levels, ElementsAre(1, 1));
  first_.error = 0;
  EXPECT_TRUE(lines_.drive_safe());
  EXPECT_THAT(first_.levels, ElementsAre(0, 1, 1));
}

TEST_F(Grouped, One_chip_goes_to_its_safe_state_without_the_others) {
  EXPECT_TRUE(lines_.drive_safe(1));
  EXPECT_THAT(second_.levels, ElementsAre(1, 1));
  EXPECT_EQ(first_.calls, 0);
}

TEST_F(Grouped, A_chip_that_was_given_up_is_not_called_any_more_and_the_others_are_driven) {
  lines_.give_up_outputs(0);
  EXPECT_FALSE(lines_.drive_each(Range::of(0, 12), Levels(12, 1)));
  EXPECT_FALSE(lines_.drive(Range::of(0, 1), Levels{1}));
  EXPECT_EQ(first_.calls, 0);
  EXPECT_THAT(second_.levels, ElementsAre(1, 1));
  Levels driven(1);
  lines_.driven(Range::of(0, 1), driven);
  EXPECT_THAT(driven, ElementsAre(0)) << "as it was driven last";
  EXPECT_TRUE(lines_.are_plugged(Range::of(0, 12)));
  EXPECT_THAT(log_.lines, ElementsAre(HasSubstr("chip0 failed: Connection timed out")));
}

TEST_F(Grouped, A_failure_is_logged_once_per_change_of_state) {
  second_.error = ENODEV;
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(lines_.drive(Range::of(1, 1), Levels{1}));
  ASSERT_EQ(log_.lines.size(), 1U);
  EXPECT_THAT(log_.lines[0], HasSubstr("chip1 failed: No such device"));
  second_.error = 0;
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(lines_.drive(Range::of(1, 1), Levels{1}));
  ASSERT_EQ(log_.lines.size(), 2U);
  EXPECT_EQ(log_.lines[1], "chip1 works again");
}

/// A group that tells of its second line what the test says.
class FakeEvents : public FakeInputs {
 public:
  using FakeInputs::FakeInputs;
  void tell(TimePoint, LineSink& sink) override {
    if (const Edges edges = std::exchange(waiting, {}); edges.any()) sink.edges(1, edges);
    for (const LevelSince& change : std::exchange(changes, {})) sink.changed(1, change.level, change.at);
  }
  std::optional<TimePoint> next_change(TimePoint) const override { return next; }
  std::optional<bool> level(std::size_t line) const override { return line == 1 && is_on; }

  Edges waiting;
  std::vector<LevelSince> changes;
  std::optional<TimePoint> next;
  bool is_on = false;
};

struct ToldEdges : EdgeSink {
  void add(std::uint16_t input, const Edges& edges) override { all.emplace_back(input, edges.rising); }
  void changed(std::uint16_t input, bool level, TimePoint at) override {
    changes.emplace_back(input, level, at);
  }
  void lost(std::uint32_t) override {}
  std::vector<std::pair<std::uint16_t, std::uint32_t>> all;
  std::vector<std::tuple<std::uint16_t, bool, TimePoint>> changes;
};

TEST(CountedLines, Edges_are_told_by_address_and_losses_logged_once_per_burst) {
  FakeLog log;
  Hardware hardware{{0, 0}};
  auto group = std::make_unique<FakeEvents>(hardware);
  FakeEvents& events = *group;
  std::vector<WiredInputs> inputs;
  inputs.push_back({std::move(group), {4, 6}});
  GroupedLines lines({}, std::move(inputs), log);
  ToldEdges told;
  TimePoint now{std::chrono::hours(1)};

  events.waiting = {3, 2, 0};
  lines.take_edges(now, told);
  lines.take_edges(now, told);
  EXPECT_THAT(told.all, ElementsAre(std::pair(6, 3)));
  EXPECT_THAT(log.lines, IsEmpty());

  for (int i = 0; i < 5; ++i) {
    now += std::chrono::milliseconds(500);
    events.waiting = {0, 0, 1};
    lines.take_edges(now, told);
  }
  ASSERT_EQ(log.lines.size(), 1U);
  EXPECT_THAT(log.lines[0], HasSubstr("chip2 line 0"));
  now += std::chrono::seconds(2);
  events.waiting = {0, 0, 1};
  lines.take_edges(now, told);
  EXPECT_EQ(log.lines.size(), 2U);
}

/// Two groups at addresses 0 and 1, and 4 and 6.
class Changes : public testing::Test {
 protected:
  Changes() {
    lines_.add({first_, {0, 1}});
    lines_.add({second_, {4, 6}});
  }
  Hardware hardware_{{0, 0}};
  FakeLog log_;
  std::shared_ptr<FakeEvents> first_ = std::make_shared<FakeEvents>(hardware_);
  std::shared_ptr<FakeEvents> second_ = std::make_shared<FakeEvents>(hardware_);
  GroupedLines lines_{{}, {}, log_};
  ToldEdges told_;
  TimePoint now_{std::chrono::hours(1)};
};

TEST_F(Changes, Each_is_told_by_address_with_its_time_whether_or_not_somebody_counts) {
  const TimePoint before = now_ - std::chrono::microseconds(3);
  second_->changes = {{true, before}, {false, now_}};
  lines_.take_edges(now_, told_);
  EXPECT_THAT(told_.changes, ElementsAre(std::tuple(6, true, before), std::tuple(6, false, now_)));
  EXPECT_THAT(told_.all, IsEmpty());
}

TEST_F(Changes, The_next_one_is_the_earliest_of_any_group) {
  EXPECT_EQ(lines_.next_change(now_), std::nullopt);
  first_->next = now_ + std::chrono::seconds(2);
  second_->next = now_ + std::chrono::seconds(1);
  EXPECT_EQ(lines_.next_change(now_), second_->next);
  second_->next.reset();
  EXPECT_EQ(lines_.next_change(now_), first_->next);
}

TEST_F(Changes, A_chip_that_is_back_tells_what_is_another_level_than_before_once) {
  second_->is_on = true;
  first_->is_on = true;
  lines_.lose_inputs(0);
  lines_.lose_inputs(1);
  lines_.take_edges(now_, told_);
  EXPECT_THAT(told_.changes, IsEmpty()) << "nobody knows";
  auto same = std::make_shared<FakeEvents>(hardware_);
  same->is_on = true;
  lines_.renew_inputs(0, {same, {0, 1}});
  lines_.renew_inputs(1, {std::make_shared<FakeEvents>(hardware_), {4, 6}});
  lines_.take_edges(now_, told_);
  lines_.take_edges(now_, told_);
  EXPECT_THAT(told_.changes, ElementsAre(std::tuple(6, false, now_)));
}

}  // namespace
}  // namespace coupler::device
