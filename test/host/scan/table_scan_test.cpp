// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/table_scan.hpp"

#include <gmock/gmock.h>

#include "test/host/scan/foreign_device.hpp"

namespace coupler::scan {
namespace {

using modbus::Range;
using test::ForeignDevice;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr Table registers = Table::holding_registers;

class TableSurveyTest : public testing::Test {
 protected:
  TableFindings look(Table table, Range window = Range::of(0, 10000), std::uint32_t stride = 16) {
    TableFindings findings(table, window);
    EXPECT_TRUE(prober_.connect());
    complete_ = TableScan(prober_, onlooker_, largest_, stride, findings).run();
    EXPECT_TRUE(onlooker_.is_in_bounds);
    return findings;
  }

  ForeignDevice device_;
  test::FakeClock clock_;
  test::Onlooker onlooker_;
  Prober prober_{device_, clock_, onlooker_, 20};
  LargestReads largest_;
  bool complete_ = false;
};

TEST_F(TableSurveyTest, A_device_that_gives_everything_is_read_in_the_largest_blocks) {
  device_.fill(registers, 0, 65535);
  const auto findings = look(registers, Range::of(0, 65536));
  EXPECT_THAT(findings.readable(), ElementsAre(Range::of(0, 65536)));
  EXPECT_EQ(device_.requests, (65536U + 124) / 125);
  EXPECT_EQ(findings.value(40000), 40000);
}

TEST_F(TableSurveyTest, Ranges_are_found_to_the_address) {
  device_.fill(registers, 0, 49);
  device_.fill(registers, 300, 301);
  device_.fill(registers, 1001, 1200);
  device_.fill(registers, 5003, 5020);
  const auto findings = look(registers);
  EXPECT_THAT(findings.readable(),
              ElementsAre(Range::of(0, 50), Range::of(300, 2), Range::of(1001, 200), Range::of(5003, 18)));
  EXPECT_TRUE(complete_);
  EXPECT_LT(device_.requests, 1300U);
}

TEST_F(TableSurveyTest, Small_holes_are_found_and_what_is_behind_them) {
  device_.fill(registers, 2000, 2400);
  for (const std::uint32_t hole : {2003U, 2004U, 2100U, 2399U}) device_.values[index(registers)].erase(hole);
  const auto findings = look(registers);
  EXPECT_THAT(findings.readable(),
              ElementsAre(Range::of(2000, 3), Range::of(2005, 95), Range::of(2101, 298), Range::of(2400, 1)));
  EXPECT_THAT(findings.holes(), ElementsAre(Range::of(2003, 2), Range::of(2100, 1), Range::of(2399, 1)));
}

TEST_F(TableSurveyTest, An_empty_table_costs_the_blocks_and_the_tries) {
  const auto findings = look(registers);
  EXPECT_THAT(findings.readable(), IsEmpty());
  EXPECT_LT(device_.requests, 1000U);
  EXPECT_EQ(findings.count(TableFindings::Seen::refused) + 80, device_.requests);
}

TEST_F(TableSurveyTest, A_table_that_no_function_reads_costs_one_request) {
  device_.without = {registers};
  const auto findings = look(registers);
  EXPECT_TRUE(findings.absent);
  EXPECT_EQ(device_.requests, 1U);
}

TEST_F(TableSurveyTest, The_first_hundred_addresses_are_all_tried) {
  device_.fill(registers, 37, 37);
  device_.fill(registers, 99, 99);
  EXPECT_THAT(look(registers).readable(), ElementsAre(Range::of(37, 1), Range::of(99, 1)));
}

TEST_F(TableSurveyTest, A_stride_of_one_finds_what_stands_alone) {
  device_.fill(registers, 777, 777);
  EXPECT_THAT(look(registers).readable(), IsEmpty());
  EXPECT_THAT(look(registers, Range::of(0, 1000), 1).readable(), ElementsAre(Range::of(777, 1)));
}

class LargestReadTest : public TableSurveyTest, public testing::WithParamInterface<modbus::Exception> {};

TEST_P(LargestReadTest, The_largest_count_that_the_device_takes_is_found) {
  device_.fill(registers, 0, 9999);
  device_.most_registers = 10;
  device_.too_many = GetParam();
  const auto findings = look(registers);
  EXPECT_TRUE(largest_.registers.is_limited);
  EXPECT_EQ(largest_.registers.count, 10U);
  EXPECT_THAT(findings.readable(), ElementsAre(Range::of(0, 10000)));
  EXPECT_LT(device_.requests, 1040U);
}
INSTANTIATE_TEST_SUITE_P(Refusals, LargestReadTest,
                         testing::Values(modbus::Exception::illegal_data_value,
                                         modbus::Exception::illegal_data_address));

TEST_F(TableSurveyTest, The_largest_count_may_be_one) {
  device_.fill(registers, 10, 40);
  device_.most_registers = 1;
  EXPECT_THAT(look(registers).readable(), ElementsAre(Range::of(10, 31)));
  EXPECT_TRUE(largest_.registers.is_limited);
  EXPECT_EQ(largest_.registers.count, 1U);
}

TEST_F(TableSurveyTest, The_largest_count_of_bits_is_found) {
  device_.fill(Table::coils, 100, 700);
  device_.most_bits = 256;
  EXPECT_THAT(look(Table::coils).readable(), ElementsAre(Range::of(100, 601)));
  EXPECT_EQ(largest_.bits.count, 256U);
  EXPECT_FALSE(largest_.registers.is_limited);
}

TEST_F(TableSurveyTest, A_short_range_says_nothing_about_the_largest_count) {
  device_.fill(registers, 0, 30);
  look(registers);
  EXPECT_FALSE(largest_.registers.is_limited);
}

TEST_F(TableSurveyTest, A_seam_is_no_limit) {
  device_.fill(registers, 0, 59);
  device_.seams = {20, 22};
  const auto findings = look(registers);
  EXPECT_THAT(findings.readable(), ElementsAre(Range::of(0, 20), Range::of(20, 2), Range::of(22, 38)));
  EXPECT_FALSE(largest_.registers.is_limited);
}

TEST_F(TableSurveyTest, A_device_that_closes_in_place_of_refusing_is_soon_asked_but_once) {
  device_.fill(registers, 0, 9);
  device_.closes_in_place_of_refusing = true;
  const auto findings = look(registers, Range::of(0, 200));
  EXPECT_THAT(findings.readable(), ElementsAre(Range::of(0, 10)));
  EXPECT_TRUE(complete_);
  EXPECT_EQ(findings.count(TableFindings::Seen::readable), 10U);
  EXPECT_LE(device_.connects, 1 + device_.refusals);
  EXPECT_LT(device_.refusals, findings.count(TableFindings::Seen::refused) + 15);
}

TEST_F(TableSurveyTest, One_lost_answer_is_asked_for_again) {
  device_.fill(registers, 0, 249);
  device_.fails = [](std::size_t request) -> std::optional<host::Error> {
    if (request == 2) return host::TransportFailure{"the device closed the connection"};
    return std::nullopt;
  };
  const auto findings = look(registers, Range::of(0, 250));
  EXPECT_THAT(findings.readable(), ElementsAre(Range::of(0, 250)));
  EXPECT_EQ(device_.requests, 3U);
  EXPECT_EQ(device_.connects, 2U);
  EXPECT_THAT(prober_.failures(), ElementsAre("the device closed the connection"));
}

TEST_F(TableSurveyTest, A_device_that_stays_silent_does_not_cost_hours) {
  device_.fails = [](std::size_t) { return host::Timeout{std::chrono::milliseconds(1000)}; };
  const auto findings = look(registers);
  EXPECT_TRUE(findings.gave_up_at.has_value());
  EXPECT_LE(device_.requests, std::size_t{most_timeouts} + 10);
  EXPECT_TRUE(complete_);
}

TEST_F(TableSurveyTest, A_device_that_is_gone_ends_the_survey) {
  device_.fill(registers, 0, 124);
  device_.fails = [this](std::size_t request) -> std::optional<host::Error> {
    if (request < 3) return std::nullopt;
    device_.refuses_connections = true;
    return host::TransportFailure{"the device closed the connection"};
  };
  const auto findings = look(registers);
  EXPECT_FALSE(complete_);
  EXPECT_THAT(findings.readable(), ElementsAre(Range::of(0, 125)));
  ASSERT_TRUE(prober_.broke_off().has_value());
  EXPECT_EQ(host::to_string(*prober_.broke_off()), "connection refused");
  EXPECT_EQ(device_.requests, 3U);
}

TEST_F(TableSurveyTest, Who_watches_can_end_it_and_keeps_what_was_found) {
  device_.fill(registers, 0, 9999);
  device_.before_request = [this] { onlooker_.ends = device_.requests == 9; };
  const auto findings = look(registers);
  EXPECT_FALSE(complete_);
  EXPECT_EQ(device_.requests, 10U);
  EXPECT_THAT(findings.readable(), ElementsAre(Range::of(0, 1250)));
}

TEST_F(TableSurveyTest, A_busy_device_is_asked_again_later) {
  device_.fill(registers, 0, 9);
  device_.fails = [](std::size_t request) -> std::optional<host::Error> {
    if (request <= 2) return host::ExceptionReply{modbus::Exception::server_device_busy};
    return std::nullopt;
  };
  EXPECT_THAT(look(registers, Range::of(0, 10)).readable(), ElementsAre(Range::of(0, 10)));
  EXPECT_EQ(device_.requests, 3U);
}

TEST_F(TableSurveyTest, Requests_keep_their_distance) {
  device_.fill(registers, 0, 1249);
  const auto before = clock_.now();
  look(registers, Range::of(0, 1250));
  EXPECT_EQ(device_.requests, 10U);
  EXPECT_GE(clock_.now() - before, 9 * std::chrono::milliseconds(50));
}

TEST_F(TableSurveyTest, The_end_of_the_address_space_is_an_end_like_any_other) {
  device_.fill(registers, 65519, 65535);
  EXPECT_THAT(look(registers, Range::of(65400, 136)).readable(), ElementsAre(Range::of(65519, 17)));
}

}  // namespace
}  // namespace coupler::scan
