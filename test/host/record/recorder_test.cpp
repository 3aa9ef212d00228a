// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/record/recorder.hpp"

#include <gmock/gmock.h>

#include "test/host/record/recorder_fixture.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using fakes::MapBuilder;
using modbus::Exception;
using std::chrono::milliseconds;
using std::chrono::seconds;
using test::lines_of;
using test::RecorderTest;
using testing::ElementsAre;
using testing::IsEmpty;

TEST_F(RecorderTest, What_the_device_is_stands_where_it_comes_online_and_where_a_file_begins) {
  record(MapBuilder().holding("a", 0));
  recorder_->on_identified(Identity::Verdict::foreign);
  come_online();
  EXPECT_THAT(taken(), ElementsAre("online, foreign"));
  EXPECT_THAT(lines_of(recorder_->all_values(start_)), ElementsAre("online, foreign"));
  recorder_->on_identified(Identity::Verdict::equal);
  EXPECT_THAT(lines_of(recorder_->all_values(start_)), ElementsAre("online, a node"));
}

TEST_F(RecorderTest, Only_changes_are_lines) {
  record(MapBuilder().holding("a", 0).holding("b", 1));
  read_registers({"a", "b"}, 0, {5, 6}, milliseconds(100));
  read_registers({"a", "b"}, 0, {5, 6}, milliseconds(200));
  read_registers({"a", "b"}, 0, {5, 7}, milliseconds(300));
  read_registers({"a", "b"}, 0, {5, 6}, milliseconds(400));
  EXPECT_THAT(taken(),
              ElementsAre("100: word a=5±0", "100: word b=6±0", "300: word b=7±0", "400: word b=6±0"));
  EXPECT_EQ(recorder_->counts().changes, 4U);
}

TEST_F(RecorderTest, Lines_are_taken_once) {
  record(MapBuilder().holding("a", 0));
  read_registers({"a"}, 0, {5});
  EXPECT_THAT(taken(), ElementsAre("1000: word a=5±0"));
  EXPECT_THAT(taken(), IsEmpty());
}

TEST_F(RecorderTest, A_line_has_the_time_of_the_value_and_how_exact_it_is) {
  record(MapBuilder().holding("a", 0));
  read_registers({"a"}, 0, {5}, milliseconds(1234), milliseconds(7));
  EXPECT_THAT(taken(), ElementsAre("1234: word a=5±7"));
}

TEST_F(RecorderTest, What_was_so_before_the_beginning_was_so_at_the_beginning) {
  record(MapBuilder().holding("a", 0));
  read_registers({"a"}, 0, {5}, milliseconds(-1));
  EXPECT_THAT(taken(), ElementsAre("0: word a=5±0"));
}

TEST_F(RecorderTest, A_value_is_all_its_registers_wherever_they_stand_in_the_reply) {
  record(MapBuilder().holding("a", 100).holding("b", 103, Type::UDINT));
  read_registers({"a", "b"}, 100, {1, 99, 99, 2, 3});
  read_registers({"b"}, 103, {2, 4});
  EXPECT_THAT(taken(), ElementsAre("1000: word a=1±0", "1000: word b=2,3±0", "1000: word b=2,4±0"));
}

TEST_F(RecorderTest, A_point_is_taken_from_where_it_reads_back) {
  record(MapBuilder().add(Table::holding_registers, "a", 0, Type::UINT,
                          [](Point& point) { point.read_address = 10; }));
  read_registers({"a"}, 9, {8, 7});
  EXPECT_THAT(taken(), ElementsAre("1000: word a=7±0"));
}

TEST_F(RecorderTest, Bits_are_compared_as_bits) {
  record(MapBuilder().coil("a", 0).add(Table::coils, "row", 1, Type::BOOL,
                                       [](Point& point) { point.count = 3; }));
  read_bits({"a", "row"}, 0, {1, 0, 1, 0});
  read_bits({"a", "row"}, 0, {1, 0, 1, 1});
  EXPECT_THAT(taken(), ElementsAre("1000: bit a=1±0", "1000: bit row=0,1,0±0", "1000: bit row=0,1,1±0"));
}

TEST_F(RecorderTest, Of_a_shared_register_each_point_has_its_own_bits) {
  const auto bit = [](std::uint8_t number) { return [=](Point& point) { point.format.bit = number; }; };
  record(MapBuilder()
             .add(Table::holding_registers, "a", 0, Type::BOOL, bit(0))
             .add(Table::holding_registers, "b", 0, Type::BOOL, bit(1)));
  read_registers({"a", "b"}, 0, {0xFFFE});
  read_registers({"a", "b"}, 0, {0x0003});
  EXPECT_THAT(taken(), ElementsAre("1000: word a=0±0", "1000: word b=2±0", "1000: word a=1±0"));
}

TEST_F(RecorderTest, After_a_loss_each_value_is_recorded_again) {
  record(MapBuilder().holding("a", 0).holding("b", 1));
  come_online();
  read_registers({"a", "b"}, 0, {5, 6});
  lose("connection lost");
  come_online();
  read_registers({"a", "b"}, 0, {5, 7});
  EXPECT_THAT(taken(), ElementsAre("online", "1000: word a=5±0", "1000: word b=6±0", "lost: connection lost",
                                   "online", "1000: word a=5±0", "1000: word b=7±0"));
}

TEST_F(RecorderTest, While_the_device_is_lost_no_value_is_known) {
  record(MapBuilder().holding("a", 0));
  come_online();
  read_registers({"a"}, 0, {5});
  EXPECT_THAT(lines_of(recorder_->all_values(start_ + seconds(2))),
              ElementsAre("online", "2000: word a=5±0"));
  lose("no route");
  EXPECT_THAT(lines_of(recorder_->all_values(start_ + seconds(3))), ElementsAre("lost: no route"));
}

TEST_F(RecorderTest, Of_the_reasons_why_a_device_is_away_the_first_is_a_line_and_no_other_report_is) {
  record(MapBuilder().holding("a", 0));
  recorder_->on_report(Level::warning, "a write was dropped");
  recorder_->on_loss("refused");
  recorder_->on_loss("no route");
  come_online();
  go_offline();
  recorder_->on_report(Level::warning, "a write was lost");
  recorder_->on_loss("no route");
  EXPECT_THAT(taken(), ElementsAre("lost: refused", "online", "lost: no route"));
}

TEST_F(RecorderTest, All_reports_are_passed_on) {
  record(MapBuilder().holding("a", 0));
  recorder_->on_report(Level::info, "connecting");
  come_online();
  recorder_->on_report(Level::error, "odd");
  recorder_->on_report(Level::error, "odd");
  EXPECT_THAT(reports_, ElementsAre("connecting", "odd", "odd"));
}

TEST_F(RecorderTest, An_exception_is_a_line_and_so_is_the_value_behind_it) {
  record(MapBuilder().holding("a", 0).holding("b", 1));
  come_online();
  read_registers({"a", "b"}, 0, {5, 6});
  refuse("a", Exception::server_device_failure, milliseconds(2000));
  refuse("a", Exception::server_device_failure, milliseconds(2100));
  refuse("a", Exception::server_device_busy, milliseconds(2200));
  reject("a", Exception::server_device_busy, milliseconds(2300));
  read_registers({"a", "b"}, 0, {5, 6}, milliseconds(2400));
  EXPECT_THAT(taken(), ElementsAre("online", "1000: word a=5±0", "1000: word b=6±0", "2000: a exception 4",
                                   "2200: a exception 6", "2300: a rejected 6", "2400: word a=5±0"));
  EXPECT_EQ(recorder_->counts().changes, 6U);
}

TEST_F(RecorderTest, An_exception_is_known_until_there_is_a_value) {
  record(MapBuilder().holding("a", 0));
  come_online();
  reject("a", Exception::illegal_data_address);
  EXPECT_THAT(lines_of(recorder_->all_values(start_ + seconds(2))),
              ElementsAre("online", "2000: a rejected 2"));
  read_registers({"a"}, 0, {5});
  EXPECT_THAT(lines_of(recorder_->all_values(start_ + seconds(3))),
              ElementsAre("online", "3000: word a=5±0"));
}

TEST_F(RecorderTest, An_exception_that_is_there_after_a_loss_is_recorded_again) {
  record(MapBuilder().holding("a", 0));
  come_online();
  refuse("a", Exception::server_device_failure);
  go_offline();
  come_online();
  refuse("a", Exception::server_device_failure);
  EXPECT_THAT(taken(), ElementsAre("online", "1000: a exception 4", "online", "1000: a exception 4"));
}

TEST_F(RecorderTest, An_exception_that_came_before_the_device_was_online_is_a_line_behind_it) {
  record(MapBuilder().holding("a", 0));
  refuse("a", Exception::server_device_failure);
  EXPECT_THAT(taken(), IsEmpty());
  values_->online(true);
  recorder_->on_online(true);
  EXPECT_THAT(taken(), ElementsAre("online", testing::EndsWith(": a exception 4")));
}

TEST_F(RecorderTest, A_value_that_the_beginning_of_a_file_has_is_no_line_behind_it) {
  record(MapBuilder().holding("a", 0));
  come_online();
  read_registers({"a"}, 0, {5});
  const ReadSpan whole = span(Table::holding_registers, 0, 1, {"a"});
  values_->store(whole, test::Words{6}, {start_ + milliseconds(3000), {}}, start_ + milliseconds(3000));
  const Recorder::Turn turn = recorder_->turn(start_ + milliseconds(2900));  // between the table and the sink
  EXPECT_THAT(lines_of(turn.beginning), ElementsAre("head of device", "online", "3000: word a=6±0"));
  recorder_->on_values(whole.points);
  EXPECT_THAT(taken(), IsEmpty());
}

TEST_F(RecorderTest, More_than_the_queue_holds_is_lost_and_said_once) {
  record(MapBuilder().holding("a", 0));
  const std::size_t size = Recorder::longest_queue / 4;
  for (const char each : {'a', 'b', 'c', 'd', 'e'}) lose(std::string(size, each));
  const Recorder::Taken first = take();
  EXPECT_TRUE(first.lost);
  EXPECT_LE(first.lines.size(), Recorder::longest_queue);
  EXPECT_EQ(lines_of(first.lines).size(), 3U);
  EXPECT_THAT(taken(), IsEmpty());
  come_online();
  EXPECT_THAT(taken(), ElementsAre("online")) << "there is room again";
}

TEST_F(RecorderTest, A_value_that_was_lost_is_among_all_values) {
  record(MapBuilder().holding("a", 0));
  for (const char each : {'a', 'b'}) lose(std::string(Recorder::longest_queue / 2, each));
  lose(std::string(Recorder::longest_queue / 2 - 20, 'c'));
  come_online();
  read_registers({"a"}, 0, {5});
  EXPECT_TRUE(take().lost);
  EXPECT_THAT(lines_of(recorder_->all_values(start_ + seconds(2))),
              ElementsAre("online", "2000: word a=5±0"));
}

TEST_F(RecorderTest, A_file_begins_with_its_head_and_all_that_is_known) {
  record(MapBuilder("press").holding("a", 0).holding("b", 1));
  EXPECT_THAT(lines_of(recorder_->beginning(start_)),
              ElementsAre("head of press", "lost: not connected yet"));
  come_online();
  read_registers({"b"}, 1, {6}, seconds(1), milliseconds(3));
  EXPECT_THAT(lines_of(recorder_->beginning(start_ + seconds(2))),
              ElementsAre("head of press", "online", "2000: word b=6±3"));
}

TEST_F(RecorderTest, Between_a_file_and_the_next_one_no_change_is_in_both) {
  record(MapBuilder("press").holding("a", 0));
  come_online();
  read_registers({"a"}, 0, {5});
  const Recorder::Turn turn = recorder_->turn(start_ + seconds(2));
  EXPECT_THAT(lines_of(turn.before.lines), ElementsAre("online", "1000: word a=5±0"));
  EXPECT_THAT(lines_of(turn.beginning), ElementsAre("head of press", "online", "2000: word a=5±0"));
  EXPECT_THAT(taken(), IsEmpty());
}

TEST_F(RecorderTest, What_comes_of_its_own_end_is_no_loss_of_the_device) {
  record(MapBuilder().holding("a", 0));
  come_online();
  recorder_->end_comes();
  lose("interrupted");
  EXPECT_THAT(taken(), ElementsAre("online"));
  EXPECT_THAT(lines_of(recorder_->all_values(start_ + seconds(2))), ElementsAre("online"));
}

TEST_F(RecorderTest, What_is_missing_counts_from_the_beginning) {
  record(MapBuilder().holding("a", 0));
  EXPECT_EQ(recorder_->missing(start_ + seconds(3), start_ + seconds(2), "full"),
            "3000: missing since 2000: full\n");
  EXPECT_EQ(recorder_->end(start_ + seconds(4)), "4000: end\n");
}

TEST_F(RecorderTest, Counts_say_how_many_points_have_a_value) {
  record(MapBuilder().holding("a", 0).holding("b", 1).holding("c", 2));
  EXPECT_FALSE(recorder_->counts().was_online);
  come_online();
  read_registers({"a", "b"}, 0, {5, 6});
  refuse("b", Exception::server_device_failure);
  EXPECT_EQ(recorder_->counts().good, 1U);
  EXPECT_TRUE(recorder_->counts().online);
  go_offline();
  EXPECT_EQ(recorder_->counts().good, 0U);
  EXPECT_FALSE(recorder_->counts().online);
  EXPECT_TRUE(recorder_->counts().was_online);
}

constexpr RawRange none[] = {{0x8000, 0x8000}};

TEST_F(RecorderTest, A_value_that_is_none_is_a_line_when_it_comes_and_when_it_goes) {
  record(MapBuilder().add(Table::holding_registers, "a", 0, Type::INT,
                          [](Point& point) { point.invalid = none; }));
  read_registers({"a"}, 0, {0x8000}, milliseconds(100));
  read_registers({"a"}, 0, {0x8000}, milliseconds(200));
  come_online();
  read_registers({"a"}, 0, {5}, milliseconds(300));
  read_registers({"a"}, 0, {0x8000}, milliseconds(400));
  read_registers({"a"}, 0, {5}, milliseconds(500));
  EXPECT_THAT(taken(), ElementsAre("100: a invalid 32768", "online", "300: word a=5±0",
                                   "400: a invalid 32768", "500: word a=5±0"));
}

TEST_F(RecorderTest, A_file_begins_with_a_value_that_is_none) {
  record(MapBuilder().add(Table::holding_registers, "a", 0, Type::INT,
                          [](Point& point) { point.invalid = none; }));
  come_online();
  read_registers({"a"}, 0, {0x8000});
  EXPECT_THAT(lines_of(recorder_->all_values(start_)), ElementsAre("online", "1000: a invalid 32768"));
  EXPECT_EQ(recorder_->counts().good, 0U);
}

TEST_F(RecorderTest, After_an_interruption_a_value_that_is_none_is_recorded_when_it_is_read) {
  record(MapBuilder().add(Table::holding_registers, "a", 0, Type::INT,
                          [](Point& point) { point.invalid = none; }));
  come_online();
  read_registers({"a"}, 0, {0x8000}, milliseconds(100));
  go_offline();
  come_online();
  read_registers({"a"}, 0, {0x8000}, milliseconds(900));
  EXPECT_THAT(taken(), ElementsAre("online", "100: a invalid 32768", "online", "900: a invalid 32768"));
}

TEST_F(RecorderTest, An_exception_after_no_value_is_recorded_and_the_value_before_an_interruption_is_not) {
  record(MapBuilder().add(Table::holding_registers, "a", 0, Type::INT,
                          [](Point& point) { point.invalid = none; }));
  come_online();
  read_registers({"a"}, 0, {0x8000}, milliseconds(100));
  refuse("a", Exception::server_device_busy, milliseconds(200));
  go_offline();
  come_online();
  refuse("a", Exception::server_device_busy, milliseconds(300));
  EXPECT_THAT(taken(), ElementsAre("online", "100: a invalid 32768", "200: a exception 6", "online",
                                   "300: a exception 6"));
}

}  // namespace
}  // namespace coupler::host
