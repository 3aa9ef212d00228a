// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "coupler/host/record/record_format.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/host/record/record_moment.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using fakes::MapBuilder;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using test::some_moment;

const std::string csv_when = "1.500000,2026-11-21T13:20:11.123Z,";

/// The row of a value of that type, from its column `value` on.
std::string csv_value(Type type, const std::vector<std::uint16_t>& registers, std::uint16_t count = 1) {
  const MapPtr map = MapBuilder()
                         .add(Table::holding_registers, "level", 0, type,
                              [&](Point& point) {
                                point.count = count;
                                point.format.length = static_cast<std::uint16_t>(2 * registers.size());
                              })
                         .build();
  const std::string row = csv_format()->value(some_moment(), map->map().points[0], registers,
                                              microseconds(250), PointQuality::State::good);
  const std::string front = csv_when + "level,";
  EXPECT_EQ(row.substr(0, front.size()), front);
  return row.substr(front.size());
}

/// As the registers of a STRING with its first character in the high byte.
std::vector<std::uint16_t> text_registers(const std::string& text) {
  std::vector<std::uint16_t> registers((text.size() + 1) / 2);
  for (std::size_t i = 0; i < text.size(); ++i)
    registers[i / 2] |=
        static_cast<std::uint16_t>(static_cast<unsigned char>(text[i]) << (i % 2 == 0 ? 8 : 0));
  return registers;
}

std::string csv_text(const std::string& text) {
  const std::string rest = csv_value(Type::STRING, text_registers(text));
  const std::string back = ",good,0.000250\n";
  EXPECT_EQ(rest.substr(rest.size() - back.size()), back);
  return rest.substr(0, rest.size() - back.size());
}

TEST(CsvFormat, A_file_begins_with_the_names_of_its_columns) {
  EXPECT_EQ(csv_format()->head({}, some_moment()), "t,utc,point,value,quality,u\n");
}

TEST(CsvFormat, A_value_is_a_row) {
  EXPECT_EQ(csv_value(Type::REAL, {0x4048, 0xF5C3}), "3.14,good,0.000250\n");
  EXPECT_EQ(csv_value(Type::INT, {0xFFFB}), "-5,good,0.000250\n");
  EXPECT_EQ(csv_value(Type::REAL, {0x0DA2, 0x4260}), "1e-30,good,0.000250\n");
  EXPECT_EQ(csv_value(Type::REAL, {0x8DA2, 0x4260}), "-1e-30,good,0.000250\n");
}

TEST(CsvFormat, A_bit_is_true_or_false) {
  const MapPtr map = MapBuilder().coil("lamp", 0).build();
  const std::uint16_t on = 1;
  EXPECT_EQ(csv_format()->value(some_moment(), map->map().points[0], {&on, 1}, {}, PointQuality::State::good),
            csv_when + "lamp,true,good,0.000000\n");
}

TEST(CsvFormat, The_elements_of_an_array_are_one_cell) {
  EXPECT_EQ(csv_value(Type::INT, {1, 0xFFFF}, 2), "\"[1, -1]\",good,0.000250\n");
}

TEST(CsvFormat, Quotes_commas_and_newlines_of_a_text_stay_in_its_cell) {
  EXPECT_EQ(csv_text("plain"), "plain");
  EXPECT_EQ(csv_text("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_text("the \"a\""), R"("the ""a""")");
  EXPECT_EQ(csv_text("a\r\nb"), "\"a\r\nb\"");
}

TEST(CsvFormat, A_text_of_the_device_is_no_formula) {
  EXPECT_EQ(csv_text("=1+2"), "'=1+2");
  EXPECT_EQ(csv_text("@sum"), "'@sum");
  EXPECT_EQ(csv_text("+cmd|' /C calc'!A0"), "'+cmd|' /C calc'!A0");
  EXPECT_EQ(csv_text("-a\""), "\"'-a\"\"\"");
  EXPECT_EQ(csv_text("\t=1"), "\"'\t=1\"");
  EXPECT_EQ(csv_text("a=1"), "a=1");
}

TEST(CsvFormat, What_is_no_value_is_in_the_column_of_the_quality) {
  const MapPtr map = MapBuilder().holding("level", 0).build();
  const auto format = csv_format();
  EXPECT_EQ(format->no_value(some_moment(), map->map().points[0], PointQuality::State::exception, 11),
            csv_when + "level,,exception: exception 0B,\n");
  EXPECT_EQ(format->online(some_moment(), true), csv_when + ",,online,\n");
  EXPECT_EQ(format->lost(some_moment(), "no reply, \"timeout\""),
            csv_when + ",,\"lost: no reply, \"\"timeout\"\"\",\n");
  EXPECT_EQ(format->clock(some_moment(), -milliseconds(3600250)),
            csv_when + ",,the clock was set by -3600.250 s,\n");
  EXPECT_EQ(format->missing(some_moment(), milliseconds(250), "the disk is full"),
            csv_when + ",,missing since 0.250000: the disk is full,\n");
  EXPECT_EQ(format->end(some_moment()), csv_when + ",,end,\n");
}

}  // namespace
}  // namespace coupler::host
