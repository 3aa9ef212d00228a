// SPDX-License-Identifier: Apache-2.0
#include "coupler/record/reader.hpp"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/common/record/moments.hpp"

namespace coupler::record {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

const std::string head_text = head_line(example_head(), at_second(0));
const std::string remark = end_line(at_second(9));

/// The lines behind a head.
struct Read {
  std::vector<Line> lines;
  std::string error;
};
Read read(const std::string& lines) {
  std::istringstream text(head_text + lines);
  auto reader = Reader::open(text, "press.jsonl");
  if (!reader) return {{}, "head: " + reader.error()};
  Read found;
  for (;;) {
    auto line = reader->next();
    if (!line) found.error = line.error();
    if (!line || !*line) return found;
    found.lines.push_back(**line);
  }
}

template <class What>
What only(const std::string& line) {
  const Read found = read(line);
  EXPECT_EQ(found.error, "");
  if (found.lines.size() != 1 || !std::holds_alternative<What>(found.lines[0].what)) {
    ADD_FAILURE() << "not one line of its kind: " << line;
    return {};
  }
  return std::get<What>(found.lines[0].what);
}

std::string error_of(const std::string& lines) { return read(lines).error; }

std::string head_error(const std::string& text) {
  std::istringstream in(text);
  const auto reader = Reader::open(in, "press.jsonl");
  return reader ? "" : reader.error();
}

/// A text with one part of it replaced.
std::string with(std::string text, const std::string& part, const std::string& other) {
  const std::size_t at = text.find(part);
  if (at == std::string::npos) ADD_FAILURE() << part << " is not in " << text;
  return at == std::string::npos ? text : text.replace(at, part.size(), other);
}

TEST(RecordReader, A_head_is_read_back) {
  std::istringstream text(head_line(example_head(), at_second(2.5)));
  auto reader = Reader::open(text, "press.jsonl");
  ASSERT_TRUE(reader) << reader.error();
  const Head& head = reader->head();
  EXPECT_EQ(head.name, "press");
  EXPECT_EQ(head.device, "192.168.1.20:502");
  EXPECT_EQ(head.fingerprint, "0123456789abcdef");
  EXPECT_EQ(head.map, example_head().map);
  EXPECT_THAT(head.periods, ElementsAre(Pair("lamp", 0.5)));
  EXPECT_THAT(head.not_recorded, ElementsAre(Pair("reset", "write-only")));
  EXPECT_EQ(reader->begin().since_start, milliseconds(2500));
  EXPECT_EQ(reader->begin().wall, at_second(0).wall);
  EXPECT_FALSE(*reader->next());
}

TEST(RecordReader, Every_line_has_its_times) {
  for (const std::string& line :
       {value_line(at_second(1.5), "lamp", "true", {}, {}),
        no_value_line(at_second(1.5), "lamp", "exception", 4), online_line(at_second(1.5), true),
        lost_line(at_second(1.5), "why"), clock_line(at_second(1.5), milliseconds(1)),
        missing_line(at_second(1.5), {}, "why"), end_line(at_second(1.5))}) {
    const Read found = read(line);
    ASSERT_EQ(found.lines.size(), 1U) << line << found.error;
    EXPECT_EQ(found.lines[0].at.since_start, milliseconds(1500)) << line;
    EXPECT_EQ(found.lines[0].at.wall, at_second(0).wall) << line;
  }
}

TEST(RecordReader, A_time_is_read_back_to_the_microsecond) {
  for (const long each : {1L, 300000L, 1001000L, 86399999999L}) {
    const std::chrono::microseconds time(each);
    const Read found = read(end_line({time, at_second(0).wall}));
    ASSERT_EQ(found.lines.size(), 1U) << each << found.error;
    EXPECT_EQ(found.lines[0].at.since_start, time);
  }
}

TEST(RecordReader, The_registers_of_a_value_are_read_back_whatever_the_value_is) {
  const std::uint16_t registers[] = {0, 1, 0x8000, 0xFFFF};
  for (const char* value : {"3.5", "null", "\"text\"", "[1,2]", "true"}) {
    const auto read = only<Value>(value_line(at_second(0), "level", value, milliseconds(1), registers));
    EXPECT_EQ(read.point, "level");
    EXPECT_THAT(read.registers, ElementsAre(0, 1, 0x8000, 0xFFFF)) << value;
  }
}

TEST(RecordReader, Bits_are_read_back_as_0_and_1) {
  EXPECT_THAT(only<Value>(value_line(at_second(0), "lamp", "true", {}, {})).registers, ElementsAre(1));
  EXPECT_THAT(only<Value>(value_line(at_second(0), "lamp", "false", {}, {})).registers, ElementsAre(0));
  EXPECT_THAT(only<Value>(value_line(at_second(0), "row", "[true,false,true]", {}, {})).registers,
              ElementsAre(1, 0, 1));
}

TEST(RecordReader, An_exception_is_read_back) {
  const auto read = only<NoValue>(no_value_line(at_second(0), "level", "rejected", 2));
  EXPECT_EQ(read.point, "level");
  EXPECT_EQ(read.quality, "rejected");
  EXPECT_EQ(read.exception, 2);
}

TEST(RecordReader, The_device_is_online_or_lost) {
  EXPECT_TRUE(only<DeviceState>(online_line(at_second(0), true)).online);
  EXPECT_FALSE(only<DeviceState>(lost_line(at_second(0), "timeout")).online);
}

TEST(RecordReader, A_device_is_foreign_if_the_recording_says_so) {
  EXPECT_TRUE(only<DeviceState>(online_line(at_second(0), false)).is_foreign);
  for (const auto node : {std::optional(true), std::optional<bool>()})
    EXPECT_FALSE(only<DeviceState>(online_line(at_second(0), node)).is_foreign);
  EXPECT_THAT(error_of(with(online_line(at_second(0), false), "\"foreign\":true", "\"foreign\":1")),
              HasSubstr("'foreign'"));
}

TEST(RecordReader, What_is_of_no_device_and_no_point_is_a_remark) {
  only<Remark>(clock_line(at_second(0), milliseconds(-100)));
  only<Remark>(missing_line(at_second(0), {}, "why"));
  only<Remark>(end_line(at_second(0)));
}

TEST(RecordReader, A_text_that_was_not_UTF_8_is_read_back) {
  EXPECT_FALSE(only<DeviceState>(lost_line(at_second(0), "\xFF\xC0")).online);
  Head head = example_head();
  head.not_recorded = {{"reset", "\xFF"}};
  EXPECT_EQ(head_error(head_line(head, at_second(0))), "");
}

TEST(RecordReader, A_recording_of_a_newer_version_is_refused_with_what_to_do) {
  EXPECT_EQ(head_error(with(head_text, "\"record\":1", "\"record\":2")),
            "press.jsonl:1: the recording has version 2, and this program reads 1; play it with the release "
            "that made it");
}

TEST(RecordReader, What_is_no_recording_is_refused_with_what_makes_one) {
  for (const std::string& text :
       {std::string(), std::string("\n"), std::string("name: press\n"), std::string("[]\n"),
        std::string("{\"name\":\"press\"}\n"), std::string("t,utc,point,value,quality,u\n"), remark,
        head_text.substr(0, head_text.size() / 2)})
    EXPECT_EQ(head_error(text), "press.jsonl:1: this is no recording; `coupler record` makes one") << text;
}

TEST(RecordReader, A_head_without_one_of_its_members_names_it) {
  for (const char* key : {"name", "device", "fingerprint", "map", "not_recorded", "periods", "t", "utc"})
    EXPECT_EQ(head_error(with(head_text, "\"" + std::string(key) + "\":", "\"x\":")),
              "press.jsonl:1: it has no '" + std::string(key) + "'");
}

TEST(RecordReader, A_member_of_another_type_names_the_file_and_the_line) {
  EXPECT_EQ(head_error(with(head_text, "\"press\"", "7")), "press.jsonl:1: 'name' is of another type");
  EXPECT_EQ(head_error(with(head_text, "\"record\":1", "\"record\":\"1\"")),
            "press.jsonl:1: 'record' is of another type");
  const std::string exception = no_value_line(at_second(0), "level", "exception", 4);
  EXPECT_EQ(error_of(remark + with(exception, "\"level\"", "[]")),
            "press.jsonl:3: 'point' is of another type");
  EXPECT_EQ(error_of(with(exception, "\"exception\":4", "\"exception\":\"4\"")),
            "press.jsonl:2: 'exception' is of another type");
  EXPECT_EQ(error_of(with(exception, "\"t\":0.000000", "\"t\":\"0\"")),
            "press.jsonl:2: 't' is of another type");
  EXPECT_EQ(error_of(with(online_line(at_second(0), true), "\"online\"", "true")),
            "press.jsonl:2: 'device' is of another type");
}

TEST(RecordReader, Registers_are_a_list_of_numbers) {
  const std::uint16_t registers[] = {12345};
  const std::string line = value_line(at_second(0), "level", "1", {}, registers);
  for (const char* wrong : {"7", "\"7\"", "[\"7\"]", "[[7]]", "null"})
    EXPECT_EQ(error_of(with(line, "[12345]", wrong)), "press.jsonl:2: 'registers' is of another type")
        << wrong;
}

TEST(RecordReader, A_number_that_does_not_fit_is_refused) {
  const std::uint16_t registers[] = {12345};
  const std::string line = value_line(at_second(0), "level", "1", {}, registers);
  for (const char* wrong : {"[65536]", "[-1]", "[1.5]"})
    EXPECT_EQ(error_of(with(line, "[12345]", wrong)),
              "press.jsonl:2: 'registers' has a number that is not 0 to 65535")
        << wrong;
  EXPECT_EQ(error_of(with(no_value_line(at_second(0), "level", "exception", 4), ":4}", ":256}")),
            "press.jsonl:2: 'exception' has a number that is not 0 to 127");
}

TEST(RecordReader, A_value_without_registers_is_bits) {
  for (const char* wrong : {"1", "\"true\"", "null", "[true,1]"})
    EXPECT_EQ(error_of(value_line(at_second(0), "lamp", wrong, {}, {})),
              "press.jsonl:2: 'value' of a point without 'registers' is true or false")
        << wrong;
}

TEST(RecordReader, A_time_that_no_recording_has_is_refused) {
  for (const char* wrong : {"-0.000001", "1e9", "1e300"})
    EXPECT_EQ(error_of(with(remark, "9.000000", wrong)), "press.jsonl:2: 't' is no time of a recording");
  EXPECT_EQ(error_of(with(remark, "T13:20:11.123Z", " 13:20")),
            "press.jsonl:2: '2026-11-21 13:20' is no time, as 2026-11-21T13:20:11.123Z");
}

TEST(RecordReader, JSON_that_is_no_object_is_refused) {
  EXPECT_EQ(error_of("[1]\n"), "press.jsonl:2: it is not a JSON object");
}

TEST(RecordReader, A_last_line_that_is_cut_short_is_the_end) {
  for (std::size_t size = 0; size + 1 < remark.size() - 1; ++size) {
    const Read found = read(remark + remark.substr(0, size));
    EXPECT_EQ(found.error, "") << size;
    EXPECT_EQ(found.lines.size(), 1U) << size;
  }
}

TEST(RecordReader, A_last_line_of_which_only_the_newline_is_missing_counts) {
  EXPECT_EQ(read(remark + remark.substr(0, remark.size() - 1)).lines.size(), 2U);
}

TEST(RecordReader, A_line_in_the_middle_that_is_cut_short_is_an_error) {
  const Read found = read(remark + remark.substr(0, 20) + "\n" + remark);
  EXPECT_EQ(found.lines.size(), 1U);
  EXPECT_EQ(found.error, "press.jsonl:3: this is no JSON");
}

TEST(RecordReader, Empty_lines_do_not_count_but_for_the_number_of_a_line) {
  const Read found = read("\n" + remark + "\n\n[]\n");
  EXPECT_EQ(found.lines.size(), 1U);
  EXPECT_THAT(found.error, HasSubstr("press.jsonl:6: "));
}

TEST(RecordReader, Members_that_nobody_knows_are_passed_over) {
  EXPECT_TRUE(only<DeviceState>(with(online_line(at_second(0), true), "{", "{\"later\":[1],")).online);
  EXPECT_EQ(head_error(with(head_text, "\"name\"", "\"later\":{},\"name\"")), "");
}

TEST(RecordReader, A_value_that_is_nested_deep_is_an_error_and_takes_no_stack) {
  const std::string deep(100'000, '[');
  const std::string line = R"({"t":1,"utc":"2026-11-28T21:48:42.710Z","point":"a","value":)" + deep +
                           std::string(deep.size(), ']') + "}\n";
  EXPECT_EQ(read(line + remark).error, "press.jsonl:2: this is no JSON");
}

}  // namespace
}  // namespace coupler::record
