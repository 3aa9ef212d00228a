// SPDX-License-Identifier: Apache-2.0
#include "coupler/record/lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/common/record/moments.hpp"

namespace coupler::record {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

const std::string when = R"({"t":1.500000,"utc":"2026-11-21T13:20:11.123Z",)";

TEST(RecordLines, The_head_begins_with_its_version_and_ends_with_the_map) {
  const std::string line = head_line(example_head(), at_second(1.5));
  EXPECT_THAT(line, StartsWith(R"({"record":1,"name":"press","device":"192.168.1.20:502",)"
                               R"("fingerprint":"0123456789abcdef","began":"2026-11-21T13:20:09.623Z",)"
                               R"("t":1.5,"utc":"2026-11-21T13:20:11.123Z","periods":{"lamp":0.5},)"
                               R"("not_recorded":{"reset":"write-only"},)"));
  EXPECT_THAT(line, EndsWith(R"("map":"name: press\nmapping: {coils: {lamp: 0}}\n"})"
                             "\n"));
}

TEST(RecordLines, The_head_names_what_may_be_missed) {
  Head head = example_head();
  head.may_miss = {{"lamp", "pulses of 20 ms"}};
  EXPECT_THAT(head_line(head, at_second(0)), HasSubstr(R"("may_miss":{"lamp":"pulses of 20 ms"})"));
}

TEST(RecordLines, A_value_has_what_it_means_and_the_registers_as_on_the_wire) {
  const std::uint16_t registers[] = {0x4048, 0xF5C3};
  EXPECT_EQ(value_line(at_second(1.5), "level", "3.14", microseconds(250), registers),
            when + R"("point":"level","value":3.14,"quality":"good","u":0.000250,"registers":[16456,62915]})"
                   "\n");
}

TEST(RecordLines, A_bit_has_no_registers) {
  EXPECT_EQ(value_line(at_second(1.5), "lamp", "true", microseconds(0), {}),
            when + R"("point":"lamp","value":true,"quality":"good","u":0.000000})"
                   "\n");
}

TEST(RecordLines, A_point_without_a_value_says_why) {
  EXPECT_EQ(no_value_line(at_second(1.5), "level", "exception", 6),
            when + R"("point":"level","value":null,"quality":"exception","exception":6})"
                   "\n");
}

TEST(RecordLines, What_is_not_of_a_point_has_a_key_of_its_own) {
  EXPECT_EQ(online_line(at_second(1.5), std::nullopt), when + "\"device\":\"online\"}\n");
  EXPECT_EQ(online_line(at_second(1.5), true), when + R"("device":"online","foreign":false})"
                                                      "\n");
  EXPECT_EQ(online_line(at_second(1.5), false), when + R"("device":"online","foreign":true})"
                                                       "\n");
  EXPECT_EQ(lost_line(at_second(1.5), "no \"route\"\n"), when + R"("device":"lost","why":"no \"route\"\n"})"
                                                                "\n");
  EXPECT_EQ(clock_line(at_second(1.5), -milliseconds(3600250)), when + "\"clock\":-3600.250000}\n");
  EXPECT_EQ(missing_line(at_second(1.5), milliseconds(250), "the disk is full"),
            when + R"("missing_since":0.250000,"why":"the disk is full"})"
                   "\n");
  EXPECT_EQ(end_line(at_second(1.5)), when + "\"end\":true}\n");
}

TEST(RecordLines, What_is_not_UTF_8_is_replaced) {
  EXPECT_EQ(lost_line(at_second(1.5), "\xFF!"), when + "\"device\":\"lost\",\"why\":\"\xEF\xBF\xBD!\"}\n");
  EXPECT_THAT(missing_line(at_second(1.5), {}, "caf\xE9"), HasSubstr("\"caf\xEF\xBF\xBD\""));
  Head head = example_head();
  head.name = "\xC3";
  EXPECT_THAT(head_line(head, at_second(0)), HasSubstr("\"name\":\"\xEF\xBF\xBD\""));
}

}  // namespace
}  // namespace coupler::record
