// SPDX-License-Identifier: Apache-2.0
// What a page is told of a device that does not answer as it should, the loop check, and the curves.
#include <gmock/gmock.h>

#include "coupler/host/panel/live_values.hpp"
#include "test/host/panel/live_values_fixture.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using fakes::MapBuilder;
using modbus::Exception;
using nlohmann::ordered_json;
using std::chrono::hours;
using std::chrono::seconds;
using test::LiveValuesTest;
using test::Names;
using test::State;

TEST_F(LiveValuesTest, A_device_begins_offline) {
  show(MapBuilder().holding("a", 0));
  EXPECT_EQ(news()["device"]["online"], false);
  set_online(true);
  EXPECT_EQ(news()["device"]["online"], true);
}

TEST_F(LiveValuesTest, What_a_lost_device_had_is_shown_as_offline) {
  show(MapBuilder().holding("a", 0).holding("b", 1));
  set_online(true);
  read_registers({"a", "b"}, 0, {5, 6});
  news();
  set_online(false);
  values_->on_loss("connection lost: no answer");
  const ordered_json told = news();
  EXPECT_EQ(told["device"]["online"], false);
  EXPECT_EQ(told["device"]["why"], "connection lost: no answer");
  for (const char* point : {"a", "b"}) EXPECT_EQ(told["points"][point]["quality"], "offline") << point;
  EXPECT_EQ(told["points"]["a"]["value"], 5) << "its last value";
}

TEST_F(LiveValuesTest, What_was_answered_with_an_exception_is_offline_as_well_when_the_device_is_lost) {
  show(MapBuilder().holding("a", 0).holding("b", 1));
  set_online(true);
  refuse("a", Exception::server_device_failure);
  reject("b", Exception::illegal_data_address);
  set_online(false);
  EXPECT_EQ(quality("a"), "offline");
  EXPECT_EQ(quality("b"), "offline");
}

TEST_F(LiveValuesTest, A_value_is_good_again_when_it_is_read_again_even_the_same_one) {
  show(MapBuilder().holding("a", 0));
  set_online(true);
  read_registers({"a"}, 0, {5});
  const auto changes = news()["points"]["a"]["changes"].get<int>();
  set_online(false);
  values_->on_loss("lost");
  news();
  set_online(true);
  const ordered_json back = news();
  EXPECT_EQ(back["device"]["online"], true);
  EXPECT_EQ(back["device"].value("why", ""), "") << "why it was lost is over";
  read_registers({"a"}, 0, {5}, seconds(1));
  const ordered_json point = news()["points"]["a"];
  EXPECT_EQ(point["quality"], "good");
  EXPECT_EQ(point["changes"], changes) << "it has not changed";
}

TEST_F(LiveValuesTest, An_exception_is_told_with_its_code_and_once) {
  show(MapBuilder().holding("a", 0).holding("b", 1));
  set_online(true);
  read_registers({"a", "b"}, 0, {5, 6});
  news();
  refuse("a", Exception::server_device_failure);
  const ordered_json told = news();
  EXPECT_EQ(names_of(told["points"]), (Names{"a"}));
  EXPECT_EQ(told["points"]["a"]["quality"], "exception");
  EXPECT_EQ(told["points"]["a"]["exception"], 4);
  EXPECT_EQ(told["points"]["a"]["value"], 5) << "its last value";
  refuse("a", Exception::server_device_failure);
  EXPECT_EQ(names_of(news()["points"]), Names());
  refuse("a", Exception::illegal_data_address);
  EXPECT_EQ(news()["points"]["a"]["exception"], 2);
  read_registers({"a", "b"}, 0, {5, 6}, seconds(1));
  const ordered_json good = news();
  EXPECT_EQ(names_of(good["points"]), (Names{"a"}));
  EXPECT_EQ(good["points"]["a"]["quality"], "good");
  EXPECT_FALSE(good["points"]["a"].contains("exception"));
}

TEST_F(LiveValuesTest, What_the_device_does_not_have_is_rejected) {
  show(MapBuilder().holding("a", 0));
  set_online(true);
  reject("a", Exception::illegal_data_address);
  const ordered_json point = news()["points"]["a"];
  EXPECT_EQ(point["quality"], "rejected");
  EXPECT_EQ(point["exception"], 2);
  EXPECT_FALSE(point.contains("value"));
}

TEST_F(LiveValuesTest, The_values_of_a_lost_device_are_offline_however_old_they_are) {
  show(MapBuilder().holding("a", 0));
  set_online(true);
  read_registers({"a"}, 0, {5}, -hours(1));
  set_online(false);
  EXPECT_EQ(quality("a"), "offline");
}

TEST_F(LiveValuesTest, What_is_read_no_more_becomes_stale) {
  show(MapBuilder().holding("a", 0));
  set_online(true);
  read_registers({"a"}, 0, {5}, -hours(1));
  EXPECT_EQ(news()["points"]["a"]["quality"], "stale");
  read_registers({"a"}, 0, {5});
  EXPECT_EQ(news()["points"]["a"]["quality"], "good");
}

TEST_F(LiveValuesTest, A_page_that_waits_is_told_when_a_value_becomes_stale) {
  MapBuilder builder;
  builder.holding("a", 0);
  builder.head().connection.timeout = std::chrono::milliseconds(100);
  builder.head().polling.rate = 20;
  show(builder);
  set_online(true);
  read_registers({"a"}, 0, {5}, std::chrono::steady_clock::now() - start_);
  const Time until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  ordered_json told = news();
  if (told["points"]["a"]["quality"] == "good")  // a busy machine may be late
    told = ordered_json::parse(values_->news(seen_, Time{}, until));
  EXPECT_EQ(told["points"]["a"]["quality"], "stale");
  EXPECT_LT(std::chrono::steady_clock::now(), until);
}

TEST_F(LiveValuesTest, Why_a_device_does_not_answer_is_told_only_while_it_does_not) {
  show(MapBuilder().holding("a", 0));
  values_->on_report(Level::warning, "a write was dropped");
  EXPECT_EQ(news()["device"]["why"], "");
  values_->on_loss("connection refused");
  EXPECT_EQ(news()["device"]["why"], "connection refused");
  set_online(true);
  values_->on_report(Level::warning, "something else");
  EXPECT_EQ(news_again()["device"].value("why", ""), "");
  EXPECT_THAT(reports_, testing::ElementsAre("a write was dropped", "something else"));
}

TEST_F(LiveValuesTest, The_device_s_numbers_are_told_with_it) {
  show(MapBuilder().holding("a", 0));
  news();
  DeviceSnapshot device;
  device.requests = 20;
  device.timeouts = 2;
  device.failures = 1;
  device.exceptions[2] = 4;
  values_->tell(device);
  const ordered_json told = news();
  EXPECT_EQ(told["device"]["requests"], 20);
  EXPECT_EQ(told["device"]["errors"], 7);
  EXPECT_EQ(told["device"]["round_trip_ms"], 0);
  EXPECT_EQ(names_of(told["points"]), Names());
  EXPECT_FALSE(news().contains("device")) << "it is told once";
}

TEST_F(LiveValuesTest, When_nobody_reads_any_more_nothing_is_known) {
  show(MapBuilder().holding("a", 0));
  set_online(true);
  read_registers({"a"}, 0, {5});
  values_->stopped();
  const ordered_json told = news();
  EXPECT_EQ(told["device"]["online"], false);
  EXPECT_EQ(told["points"]["a"]["quality"], "offline");
}

TEST_F(LiveValuesTest, The_loop_check_is_CSV_of_RFC_4180) {
  show(MapBuilder().coil("lamp", 0).holding("speed", 0));
  const std::string csv = values_->seen_csv();
  EXPECT_EQ(csv.substr(0, csv.find("lamp")), "point,seen_off,seen_on,changes,table,address,modicon,part\r\n");
  EXPECT_EQ(csv.substr(csv.find("lamp")),
            "lamp,no,no,0,coils,0,00001,\r\nspeed,no,no,0,holding_registers,0,40001,\r\n");
}

TEST_F(LiveValuesTest, The_loop_check_tells_what_was_seen_of_each_point) {
  show(MapBuilder().coil("on", 0).coil("off", 1).coil("both", 2).coil("never", 3).holding("speed", 0));
  read_bits({"on", "off", "both"}, 0, {1, 0, 1});
  EXPECT_EQ(seen("both"), "no,yes");
  read_bits({"on", "off", "both"}, 0, {1, 0, 0});
  EXPECT_EQ(seen("on"), "no,yes");
  EXPECT_EQ(seen("off"), "yes,no");
  EXPECT_EQ(seen("both"), "yes,yes");
  EXPECT_EQ(seen("never"), "no,no");
  read_registers({"speed"}, 0, {0});
  EXPECT_EQ(seen("speed"), "yes,no");
  read_registers({"speed"}, 0, {4711});
  EXPECT_EQ(seen("speed"), "yes,yes");
  set_online(false);
  EXPECT_EQ(seen("both"), "yes,yes") << "since the start";
}

TEST_F(LiveValuesTest, The_loop_check_knows_on_and_off_of_words_and_texts) {
  show(MapBuilder()
           .holding("word", 0, Type::WORD)
           .holding("byte", 1, fakes::half(Type::BYTE, codec::Half::low))
           .add(Table::holding_registers, "label", 2, Type::STRING,
                [](Point& point) { point.format.length = 4; }));
  read_registers({"word", "byte", "label"}, 0, {0, 0xFF00, 0, 0});
  for (const char* point : {"word", "byte", "label"}) EXPECT_EQ(seen(point), "yes,no") << point;
  read_registers({"word", "byte", "label"}, 0, {1, 1, 0x41, 0});
  for (const char* point : {"word", "byte", "label"}) EXPECT_EQ(seen(point), "yes,yes") << point;
}

TEST_F(LiveValuesTest, The_loop_check_sees_every_value_of_an_array) {
  show(MapBuilder().add(Table::coils, "lamps", 0, Type::BOOL, [](Point& point) { point.count = 3; }));
  read_bits({"lamps"}, 0, {0, 0, 0});
  EXPECT_EQ(seen("lamps"), "yes,no");
  read_bits({"lamps"}, 0, {0, 0, 1});
  EXPECT_EQ(seen("lamps"), "yes,yes");
}

TEST_F(LiveValuesTest, A_value_that_stays_has_not_changed) {
  show(MapBuilder().coil("lamp", 0));
  for (int i = 0; i < 3; ++i) read_bits({"lamp"}, 0, {1});
  EXPECT_EQ(news()["points"]["lamp"]["changes"], 0);
  read_bits({"lamp"}, 0, {0});
  EXPECT_EQ(news()["points"]["lamp"]["changes"], 1);
}

TEST_F(LiveValuesTest, A_history_has_300_steps_of_each_point) {
  show(MapBuilder().coil("lamp", 0).holding("speed", 0).holding("never", 1));
  read_bits({"lamp"}, 0, {1});
  for (const std::uint16_t value : std::array<std::uint16_t, 3>{7, 3, 9})
    read_registers({"speed"}, 0, {value});
  const ordered_json all = ordered_json::parse(values_->histories(start_));
  EXPECT_EQ(names_of(all), (Names{"lamp", "speed", "never"}));
  for (const char* point : {"lamp", "speed", "never"}) EXPECT_EQ(all[point].size(), 300U) << point;
  EXPECT_EQ(all["lamp"][299], ordered_json({1.0, 1.0}));
  EXPECT_EQ(all["speed"][299], ordered_json({3.0, 9.0}));
  EXPECT_TRUE(all["speed"][298].is_null());
  EXPECT_TRUE(all["never"][299].is_null());
}

TEST_F(LiveValuesTest, Of_a_history_the_last_steps_may_be_asked_for) {
  show(MapBuilder().holding("speed", 0));
  read_registers({"speed"}, 0, {7});
  const ordered_json two = ordered_json::parse(values_->histories(start_, 2));
  EXPECT_EQ(two["speed"].size(), 2U);
  EXPECT_EQ(two["speed"][1], ordered_json({7, 7}));
  EXPECT_EQ(ordered_json::parse(values_->histories(start_, 0))["speed"].size(), 0U);
  EXPECT_EQ(ordered_json::parse(values_->histories(start_, 1'000'000))["speed"].size(), 300U);
}

TEST_F(LiveValuesTest, A_history_ends_while_the_value_is_not_known) {
  show(MapBuilder().holding("a", 0));
  set_online(true);
  read_registers({"a"}, 0, {5});
  set_online(false);
  const auto later = std::chrono::steady_clock::now() + seconds(8);
  EXPECT_TRUE(ordered_json::parse(values_->histories(later))["a"].back().is_null());
}

TEST_F(LiveValuesTest, A_step_of_a_history_is_two_numbers_or_null) {
  show(MapBuilder().holding("real", 0, Type::REAL).holding("lreal", 2, Type::LREAL));
  read_registers({"real"}, 0, {0x4148, 0});         // 12.5
  read_registers({"real"}, 0, {0x7F80, 0});         // inf
  read_registers({"lreal"}, 2, {0, 0, 0, 0});       // 0
  read_registers({"lreal"}, 2, {0x7E37, 0, 0, 0});  // 2e300: no REAL is so great
  for (const char* point : {"real", "lreal"}) {
    const ordered_json pair = step(point);
    if (pair.is_null()) continue;
    ASSERT_EQ(pair.size(), 2U) << point;
    EXPECT_TRUE(pair[0].is_number() && pair[1].is_number()) << point << ' ' << pair;
  }
}

}  // namespace
}  // namespace coupler::host
