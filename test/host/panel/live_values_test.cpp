// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/live_values.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <thread>

#include "test/host/panel/live_values_fixture.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using fakes::MapBuilder;
using nlohmann::ordered_json;
using std::chrono::milliseconds;
using std::chrono::seconds;
using test::LiveValuesTest;
using test::Names;
using testing::ElementsAre;
using testing::IsEmpty;

MapBuilder string_map(std::uint16_t length) {
  return MapBuilder().add(Table::holding_registers, "label", 0, Type::STRING, [&](Point& point) {
    point.format.length = length;
    point.format.order = codec::Order::BADC;  // a map's default
  });
}

TEST_F(LiveValuesTest, Bits_are_true_or_false) {
  show(MapBuilder().coil("lamp", 0).input("door", 4));
  read_bits({"lamp"}, 0, {1});
  read_bits({"door"}, 4, {0});
  const ordered_json points = news()["points"];
  EXPECT_EQ(points["lamp"]["value"], true);
  EXPECT_EQ(points["lamp"]["text"], "true");
  EXPECT_EQ(points["lamp"]["quality"], "good");
  EXPECT_EQ(points["door"]["value"], false);
  EXPECT_EQ(points["door"]["text"], "false");
}

// The registers of the numbers are those of Python's struct.
TEST_F(LiveValuesTest, Numbers_are_numbers) {
  show(MapBuilder()
           .holding("int", 0, Type::INT)
           .holding("uint", 1)
           .holding("dint", 2, Type::DINT)
           .holding("real", 4, Type::REAL)
           .holding("lreal", 6, Type::LREAL)
           .holding("tenth", 10, Type::REAL));
  read_registers({"int", "uint", "dint", "real", "lreal", "tenth"}, 0,
                 {0xFFFE, 0xFFFE, 0xFFFF, 0xFB2E, 0x4148, 0, 0xC004, 0, 0, 0, 0x3DCC, 0xCCCD});
  const ordered_json points = news()["points"];
  for (const auto& [name, value] : std::map<std::string, ordered_json>{
           {"int", -2}, {"uint", 65534}, {"dint", -1234}, {"real", 12.5}, {"lreal", -2.5}, {"tenth", 0.1}}) {
    EXPECT_EQ(points[name]["value"], value) << name;
    EXPECT_EQ(points[name]["text"], value.dump()) << name;
  }
}

TEST_F(LiveValuesTest, A_scaled_value_is_what_people_read) {
  show(MapBuilder().add(Table::input_registers, "pressure", 0, Type::INT, [](Point& point) {
    point.scale = {0.1, -40};
  }));
  read_registers({"pressure"}, 0, {217}, seconds(0), Table::input_registers);
  EXPECT_EQ(news()["points"]["pressure"]["value"], -18.3);
  EXPECT_EQ(step("pressure"), ordered_json({-18.3, -18.3}));
}

TEST_F(LiveValuesTest, Words_are_shown_as_hexadecimal_numbers) {
  show(MapBuilder().holding("word", 0, Type::WORD));
  read_registers({"word"}, 0, {0x2F});
  EXPECT_EQ(news()["points"]["word"]["value"], 0x2F);
  EXPECT_EQ(news_again()["points"]["word"]["text"], "0x002F");
}

TEST_F(LiveValuesTest, A_named_value_has_its_name_as_text) {
  static constexpr std::array<NamedValue, 2> names{{{0, "OFF"}, {3, "RUNNING"}}};
  show(MapBuilder().add(Table::holding_registers, "mode", 0, Type::UINT,
                        [](Point& point) { point.values = names; }));
  read_registers({"mode"}, 0, {3});
  EXPECT_EQ(news()["points"]["mode"]["text"], "RUNNING");
  EXPECT_EQ(news_again()["points"]["mode"]["value"], 3);
  read_registers({"mode"}, 0, {7});
  EXPECT_EQ(news()["points"]["mode"]["text"], "7");
}

TEST_F(LiveValuesTest, Points_that_share_a_register_have_their_own_bits_of_it) {
  codec::Format bit;
  bit.bit = 3;
  show(MapBuilder()
           .holding("flag", 0, bit)
           .holding("high", 0, fakes::half(Type::USINT, codec::Half::high))
           .holding("low", 1, fakes::half(Type::SINT, codec::Half::low)));
  read_registers({"flag", "high", "low"}, 0, {0x1208, 0x12FE});
  ordered_json points = news()["points"];
  EXPECT_EQ(points["flag"]["value"], true);
  EXPECT_EQ(points["high"]["value"], 0x12);
  EXPECT_EQ(points["low"]["value"], -2);
  read_registers({"flag", "high", "low"}, 0, {0x1200, 0x34FE});  // the upper byte of the second is nobody's
  points = news()["points"];
  EXPECT_EQ(names_of(points), (Names{"flag"}));
  EXPECT_EQ(points["flag"]["value"], false);
  EXPECT_EQ(seen("flag"), "yes,yes");
}

TEST_F(LiveValuesTest, Arrays_are_lists) {
  const auto three = [](Point& point) { point.count = 3; };
  show(MapBuilder()
           .add(Table::coils, "lamps", 0, Type::BOOL, three)
           .add(Table::holding_registers, "curve", 10, Type::DINT, three));
  read_bits({"lamps"}, 0, {1, 0, 1});
  read_registers({"curve"}, 10, {0, 1, 0xFFFF, 0xFFFF, 0, 3});
  const ordered_json points = news()["points"];
  EXPECT_EQ(points["lamps"]["value"], ordered_json({true, false, true}));
  EXPECT_EQ(points["lamps"]["text"], "[true, false, true]");
  EXPECT_EQ(points["curve"]["value"], ordered_json({1, -1, 3}));
  EXPECT_EQ(points["curve"]["text"], "[1, -1, 3]");
}

TEST_F(LiveValuesTest, Strings_are_texts_whatever_is_in_them) {
  show(string_map(8));
  read_registers({"label"}, 0, {0x6E6F, 0x0065, 0, 0});  // its first character is in the low byte
  EXPECT_EQ(news()["points"]["label"]["value"], "one");
  read_registers({"label"}, 0, {0x2722, 0x0A3C, 0x5C2C, 0x003B});
  EXPECT_EQ(news()["points"]["label"]["value"], "\"'<\n,\\;");
  read_registers({"label"}, 0, {0xFFFE, 0xC080, 0x0041, 0});  // no UTF-8
  const std::string text = values_->news(seen_, Time{}, Time{});
  EXPECT_TRUE(ordered_json::accept(text)) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << "it ends a server-sent event";
}

TEST_F(LiveValuesTest, What_JSON_has_no_number_for_is_null_and_has_a_text) {
  show(MapBuilder().holding("real", 0, Type::REAL));
  for (const auto& [high, text] :
       std::map<std::uint16_t, std::string>{{0x7FC0, "nan"}, {0x7F80, "inf"}, {0xFF80, "-inf"}}) {
    read_registers({"real"}, 0, {high, 0});
    const ordered_json real = news()["points"]["real"];
    EXPECT_TRUE(real["value"].is_null()) << text;
    EXPECT_EQ(real["text"], text);
  }
}

TEST_F(LiveValuesTest, A_value_is_taken_from_where_it_reads_back) {
  show(MapBuilder().add(Table::holding_registers, "a", 0, Type::UINT,
                        [](Point& point) { point.read_address = 10; }));
  read_registers({"a"}, 9, {1, 2, 3});
  EXPECT_EQ(news()["points"]["a"]["value"], 2);
}

TEST_F(LiveValuesTest, Nothing_seen_yet_is_told_everything) {
  show(MapBuilder().holding("a", 0).holding("b", 1).holding("never", 2));
  read_registers({"a", "b"}, 0, {5, 6});
  const ordered_json all = news();
  EXPECT_EQ(names_of(all["points"]), (Names{"a", "b", "never"}));
  EXPECT_EQ(all["points"]["never"]["quality"], "never read");
  EXPECT_FALSE(all["points"]["never"].contains("value"));
  EXPECT_TRUE(all.contains("device"));
  std::uint64_t another = 0;
  EXPECT_EQ(names_of(ordered_json::parse(values_->news(another, Time{}, Time{}))["points"]),
            (Names{"a", "b", "never"}));
}

TEST_F(LiveValuesTest, Afterwards_only_what_is_newer) {
  show(MapBuilder().holding("a", 0).holding("b", 1));
  read_registers({"a", "b"}, 0, {5, 6});
  const ordered_json first = news();
  EXPECT_EQ(first["revision"], seen_);
  read_registers({"a", "b"}, 0, {5, 7});
  const ordered_json second = news();
  EXPECT_EQ(names_of(second["points"]), (Names{"b"}));
  EXPECT_GT(second["revision"], first["revision"]);
}

TEST_F(LiveValuesTest, What_is_the_same_is_no_news) {
  show(MapBuilder().holding("a", 0).coil("lamp", 0));
  read_registers({"a"}, 0, {5});
  read_bits({"lamp"}, 0, {1});
  const ordered_json first = news();
  read_registers({"a"}, 0, {5}, milliseconds(100));
  read_bits({"lamp"}, 0, {1});
  EXPECT_THAT(names_of(news()["points"]), IsEmpty());
  EXPECT_EQ(news_again()["points"]["a"]["changes"], first["points"]["a"]["changes"]);
}

TEST_F(LiveValuesTest, A_page_that_is_slow_loses_what_was_between) {
  show(MapBuilder().holding("a", 0));
  read_registers({"a"}, 0, {1});
  const auto before = news()["points"]["a"]["changes"].get<int>();
  for (std::uint16_t value = 2; value <= 9; ++value) read_registers({"a"}, 0, {value});
  const ordered_json point = news()["points"]["a"];
  EXPECT_EQ(point["value"], 9);
  EXPECT_EQ(point["changes"].get<int>() - before, 8) << "but it sees how many there were";
}

TEST_F(LiveValuesTest, Two_pages_are_each_told_once) {
  show(MapBuilder().holding("a", 0));
  std::uint64_t other = 0;
  read_registers({"a"}, 0, {1});
  EXPECT_EQ(names_of(news()["points"]), (Names{"a"}));
  EXPECT_EQ(names_of(ordered_json::parse(values_->news(other, Time{}, Time{}))["points"]), (Names{"a"}));
  EXPECT_THAT(names_of(ordered_json::parse(values_->news(other, Time{}, Time{}))["points"]), IsEmpty());
}

TEST_F(LiveValuesTest, The_age_is_that_of_the_change) {
  show(MapBuilder().holding("a", 0));
  read_registers({"a"}, 0, {1}, -seconds(50));
  read_registers({"a"}, 0, {2}, -seconds(40));
  read_registers({"a"}, 0, {2}, -seconds(5));
  const auto age = news()["points"]["a"]["age"].get<double>();
  EXPECT_GE(age, 40);
  EXPECT_LT(age, 100) << "a generous deadline";
}

TEST_F(LiveValuesTest, Who_waits_is_told_as_soon_as_there_is_something) {
  show(MapBuilder().holding("a", 0));
  news();
  std::string told;
  std::thread page([&] { told = values_->news(seen_, Time{}, Time::max()); });
  read_registers({"a"}, 0, {1});
  page.join();
  EXPECT_EQ(names_of(ordered_json::parse(told)["points"]), (Names{"a"}));
}

TEST_F(LiveValuesTest, Who_waits_is_told_nothing_at_the_time_that_he_gave) {
  show(MapBuilder().holding("a", 0));
  news();
  const ordered_json told =
      ordered_json::parse(values_->news(seen_, Time{}, std::chrono::steady_clock::now() + milliseconds(20)));
  EXPECT_THAT(names_of(told["points"]), IsEmpty());
}

TEST_F(LiveValuesTest, Who_is_told_often_is_not_told_before_the_time_that_he_gave) {
  show(MapBuilder().holding("a", 0));
  news();
  read_registers({"a"}, 0, {1});
  const Time earliest = std::chrono::steady_clock::now() + milliseconds(50);
  const ordered_json told = ordered_json::parse(values_->news(seen_, earliest, Time::max()));
  EXPECT_GE(std::chrono::steady_clock::now(), earliest);
  EXPECT_EQ(names_of(told["points"]), (Names{"a"}));
}

TEST_F(LiveValuesTest, The_end_ends_every_wait) {
  show(MapBuilder().holding("a", 0));
  news();
  std::atomic<int> ended{0};
  std::thread page([&] {
    std::uint64_t seen = seen_;
    values_->news(seen, Time{}, Time::max());
    ++ended;
  });
  values_->end();
  page.join();
  std::uint64_t seen = seen_;
  values_->news(seen, Time{}, Time::max());  // also one that begins later
  EXPECT_EQ(ended, 1);
}

TEST_F(LiveValuesTest, A_value_that_is_none_is_shown_as_invalid_with_the_reason) {
  static constexpr RawRange none[] = {{0x8000, 0x8000}};
  show(MapBuilder().add(Table::holding_registers, "a", 0, Type::INT,
                        [](Point& point) { point.invalid = none; }));
  values_->on_online(true);
  table_->online(true);
  read_registers({"a"}, 0, {7});
  read_registers({"a"}, 0, {0x8000}, milliseconds(1));
  const ordered_json a = news()["points"]["a"];
  EXPECT_EQ(a["quality"], "invalid");
  EXPECT_EQ(a["why"], "the device gives 0x8000, which the map calls invalid");
  EXPECT_FALSE(a.contains("value"));
  EXPECT_FALSE(a.contains("text"));
  read_registers({"a"}, 0, {7}, milliseconds(2));
  EXPECT_EQ(news()["points"]["a"]["value"], 7);
  EXPECT_EQ(quality("a"), "good");
}

}  // namespace
}  // namespace coupler::host
