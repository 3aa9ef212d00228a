// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/recognition.hpp"

#include <gmock/gmock.h>

#include "coupler/host/scan/scan.hpp"
#include "coupler/map/loader/load.hpp"
#include "test/host/scan/foreign_device.hpp"

namespace coupler::scan {
namespace {

using modbus::Range;
using testing::Each;
using testing::HasSubstr;
using testing::Property;

/// What the manual says of the registers of a 750-352 (config/presets/wago_750.yaml has the sources).
class RecognitionTest : public testing::Test {
 protected:
  RecognitionTest() {
    set(0x2002, 0x1234);
    set(0x2003, 0xAAAA);
    set(0x2011, 750);
    set(0x2012, 352);
    set(0x1022, 2 * 16);
    set(0x1023, 4 * 16);
    set(0x1024, 8);
    set(0x1025, 16);
  }

  void set(std::uint32_t address, std::uint16_t value) {
    device_.values[index(Table::holding_registers)][address] = value;
  }
  std::optional<Recognition> look() {
    Prober prober(device_, clock_, onlooker_, 20);
    device_.reads.clear();
    return recognise(prober);
  }
  LoadResult map_of(const Recognition& recognition) {
    text_ = recognised_map(recognition, {"10.0.0.7", 1502, 1});
    return load_map(text_, "recognised.yaml");
  }

  test::ForeignDevice device_;
  test::FakeClock clock_;
  test::Onlooker onlooker_;
  std::string text_;
};

TEST_F(RecognitionTest, A_WAGO_coupler_says_what_it_is_and_what_it_has) {
  const auto found = look();
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->kind, "WAGO 750-352");
  EXPECT_EQ(found->preset, "wago_750");
  EXPECT_EQ(channels_text(*found), "16 inputs, 8 outputs, 4 analogue inputs, 2 analogue outputs");
  EXPECT_FALSE(found->is_cut);
}

TEST_F(RecognitionTest, Each_register_is_asked_for_alone_and_there_are_eight) {
  look();
  EXPECT_EQ(device_.reads.size(), 8U);
  EXPECT_THAT(device_.reads, Each(Property(&Range::count, 1U)));
}

TEST_F(RecognitionTest, A_late_reply_does_not_make_it_a_stranger) {
  for (std::size_t late = 1; late <= 8; ++late) {
    device_.requests = 0;
    device_.fails = [late](std::size_t request) -> std::optional<host::Error> {
      if (request != late) return std::nullopt;
      return host::Timeout{std::chrono::milliseconds(1000)};
    };
    EXPECT_TRUE(look().has_value()) << late;
  }
}

TEST_F(RecognitionTest, Its_map_has_a_point_for_each_channel_and_its_preset_reads_outputs_back) {
  const LoadResult loaded = map_of(look().value());
  ASSERT_NE(loaded.map, nullptr) << text_;
  EXPECT_TRUE(loaded.diagnostics.empty());
  const Map& map = loaded.map->map();
  EXPECT_EQ(map.name, "wago_750_352");
  EXPECT_EQ(map.connection.address, "10.0.0.7");
  EXPECT_EQ(map.connection.port, 1502);
  ASSERT_EQ(map.points.size(), 16U + 8 + 4 + 2);
  const auto point = [&](std::string_view name) {
    for (const Point& one : map.points)
      if (one.name == name) return one;
    ADD_FAILURE() << name;
    return Point{};
  };
  EXPECT_EQ(point("input_16").address, 15U);
  EXPECT_EQ(read_range(point("output_1")).start(), 512U);
  EXPECT_EQ(point("output_8").address, 7U);
  EXPECT_EQ(point("analogue_input_4").address, 3U);
  EXPECT_EQ(read_range(point("analogue_output_2")).start(), 513U);
}

TEST_F(RecognitionTest, What_the_addresses_of_the_preset_do_not_reach_is_left_out_and_said) {
  set(0x1022, 300 * 16);
  set(0x1025, 600);
  const auto found = look();
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->inputs, 512U);
  EXPECT_EQ(found->analogue_outputs, 256U);
  const LoadResult loaded = map_of(*found);
  ASSERT_NE(loaded.map, nullptr);
  EXPECT_TRUE(loaded.diagnostics.empty());
  EXPECT_THAT(text_, HasSubstr("It has more"));
}

TEST_F(RecognitionTest, A_controller_whose_program_decides_what_is_in_its_registers_is_none) {
  set(0x2012, 8202);  // PFC200
  EXPECT_FALSE(look().has_value());
}

TEST_F(RecognitionTest, Without_terminals_there_is_nothing_to_recognise) {
  for (const std::uint32_t address : {0x1022U, 0x1023U, 0x1024U, 0x1025U}) set(address, 0);
  EXPECT_FALSE(look().has_value());
}

TEST_F(RecognitionTest, A_foreign_device_is_asked_for_one_register) {
  set(0x2002, 0x3412);
  EXPECT_FALSE(look().has_value());
  EXPECT_EQ(device_.reads.size(), 1U);
  device_.values[index(Table::holding_registers)].clear();
  EXPECT_FALSE(look().has_value());
  EXPECT_EQ(device_.reads.size(), 1U);
}

TEST_F(RecognitionTest, A_register_that_is_missing_ends_it) {
  device_.values[index(Table::holding_registers)].erase(0x1024);
  EXPECT_FALSE(look().has_value());
  EXPECT_EQ(device_.reads.size(), 7U);
}

TEST_F(RecognitionTest, A_scan_that_looks_for_it_needs_no_more) {
  Task task;
  task.ends = Task::Ends::when_known;
  const Findings findings = scan(task, device_, clock_, onlooker_);
  EXPECT_TRUE(findings.recognition.has_value());
  EXPECT_TRUE(findings.is_complete);
  EXPECT_TRUE(findings.tables.empty());
}

TEST_F(RecognitionTest, A_scan_of_everything_goes_on) {
  const Findings findings = scan({{1}, Range::of(0, 100), 16, 20}, device_, clock_, onlooker_);
  EXPECT_TRUE(findings.recognition.has_value());
  EXPECT_EQ(findings.tables.size(), 4U);
}

}  // namespace
}  // namespace coupler::scan
