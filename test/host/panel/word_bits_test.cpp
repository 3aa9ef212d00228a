// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/word_bits.hpp"

#include <gmock/gmock.h>

#include "test/host/panel/live_values_fixture.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using fakes::MapBuilder;
using nlohmann::ordered_json;
using std::chrono::seconds;
using test::LiveValuesTest;
using test::Names;

struct WordBitsTest : LiveValuesTest {
  /// The line of the loop check that begins with this name.
  std::string line(const std::string& name) const {
    const std::string csv = values_->seen_csv();
    const std::size_t from = csv.find("\n" + name + ",");
    if (from == std::string::npos) return "no such line";
    return csv.substr(from + 1, csv.find('\r', from) - from - 1);
  }
  ordered_json bits(const std::string& name) const { return news_again()["points"][name]["bits"]; }
};

TEST_F(WordBitsTest, Words_have_them_and_numbers_and_arrays_have_not) {
  const auto bits = [](Table table, Type type, auto change) {
    const auto map = MapBuilder().add(table, "a", 0, type, change).build();
    return bits_of(map->map().points[0]);
  };
  const auto as_it_is = [](Point&) {};
  EXPECT_EQ(bits(Table::holding_registers, Type::BYTE,
                 [](Point& point) { point.format = fakes::half(Type::BYTE, codec::Half::high); }),
            8U);
  EXPECT_EQ(bits(Table::holding_registers, Type::WORD, as_it_is), 16U);
  EXPECT_EQ(bits(Table::input_registers, Type::DWORD, as_it_is), 32U);
  EXPECT_EQ(bits(Table::holding_registers, Type::LWORD, as_it_is), 64U);
  EXPECT_EQ(bits(Table::holding_registers, Type::WORD, [](Point& point) { point.format.bits = 4; }), 4U);
  EXPECT_EQ(bits(Table::holding_registers, Type::WORD, [](Point& point) { point.count = 2; }), 0U);
  EXPECT_EQ(
      bits(Table::holding_registers, Type::WORD, [](Point& point) { point.access = coupler::Access::write; }),
      0U);
  EXPECT_EQ(bits(Table::holding_registers, Type::UINT, as_it_is), 0U);
  EXPECT_EQ(bits(Table::coils, Type::BOOL, as_it_is), 0U);
}

TEST_F(WordBitsTest, A_page_is_told_each_bit_and_what_was_seen_of_it) {
  show(MapBuilder().holding("status", 0, Type::WORD).holding("speed", 1));
  EXPECT_FALSE(bits("status").contains("is"));
  read_registers({"status", "speed"}, 0, {0x8005, 0});
  read_registers({"status", "speed"}, 0, {0x8004, 0});
  read_registers({"status", "speed"}, 0, {0x8005, 0});
  const ordered_json told = bits("status");
  EXPECT_EQ(told["is"], "8005");
  EXPECT_EQ(told["on"], "8005");
  EXPECT_EQ(told["off"], "7ffb");
  EXPECT_EQ(told["changes"], ordered_json({2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(news_again()["points"]["speed"].contains("bits"));
}

TEST_F(WordBitsTest, A_word_may_have_64_of_them) {
  show(MapBuilder().holding("alarms", 0, Type::LWORD));
  read_registers({"alarms"}, 0, {0x8000, 0, 0, 1});
  EXPECT_EQ(bits("alarms")["is"], "8000000000000001");
  EXPECT_EQ(bits("alarms")["off"], "7ffffffffffffffe");
  EXPECT_EQ(bits("alarms")["changes"].size(), 64U);
  EXPECT_EQ(seen("alarms.63"), "no,yes");
  EXPECT_EQ(seen("alarms.62"), "yes,no");
}

TEST_F(WordBitsTest, Each_has_a_line_in_the_loop_check) {
  show(MapBuilder()
           .holding("status", 6, Type::WORD)
           .add(Table::holding_registers, "state", 7, Type::WORD,
                [](Point& point) {
                  point.format.bit = 8;
                  point.format.bits = 4;
                })
           .holding("high", 8, fakes::half(Type::BYTE, codec::Half::high)));
  read_registers({"status", "state", "high"}, 6, {8, 0xF1FF, 0x01FF});
  read_registers({"status", "state", "high"}, 6, {0, 0xF1FF, 0x01FF});
  EXPECT_EQ(line("status"), "status,yes,yes,1,holding_registers,6,40007,");
  EXPECT_EQ(line("status.3"), "status.3,yes,yes,1,holding_registers,6,40007,bit 3");
  EXPECT_EQ(line("status.15"), "status.15,yes,no,0,holding_registers,6,40007,bit 15");
  EXPECT_EQ(line("status.16"), "no such line");
  EXPECT_EQ(line("state.0"), "state.0,no,yes,0,holding_registers,7,40008,bit 0 of bits 8 to 11");
  EXPECT_EQ(line("state.3"), "state.3,yes,no,0,holding_registers,7,40008,bit 3 of bits 8 to 11");
  EXPECT_EQ(line("state.4"), "no such line");
  EXPECT_EQ(line("high.0"), "high.0,no,yes,0,holding_registers,8,40009,bit 0 of high byte");
  EXPECT_EQ(line("high.1"), "high.1,yes,no,0,holding_registers,8,40009,bit 1 of high byte");
}

TEST_F(WordBitsTest, They_have_ten_minutes_beside_the_words) {
  show(MapBuilder().holding("status", 0, Type::WORD).holding("speed", 1));
  set_online(true);
  read_registers({"status", "speed"}, 0, {1, 0});
  read_registers({"status", "speed"}, 0, {3, 0});
  ordered_json all = ordered_json::parse(values_->histories(start_));
  EXPECT_EQ(names_of(all), (Names{"status", "status.bits", "speed"}));
  EXPECT_EQ(all["status.bits"].size(), 300U);
  EXPECT_EQ(all["status.bits"][299], ordered_json({"3", "fffe"})) << "bit 1 was on and off";
  EXPECT_TRUE(all["status.bits"][298].is_null());
  all = ordered_json::parse(values_->histories(start_ + seconds(4), 2));
  EXPECT_EQ(all["status.bits"], ordered_json::parse(R"([["3","fffc"],["3","fffc"]])"))
      << "the last value holds";
  set_online(false);
  all = ordered_json::parse(values_->histories(std::chrono::steady_clock::now() + seconds(8), 1));
  EXPECT_TRUE(all["status.bits"][0].is_null());
}

}  // namespace
}  // namespace coupler::host
