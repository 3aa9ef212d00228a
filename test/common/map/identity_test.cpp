// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/identity.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "test/common/map/sample_points.hpp"

namespace coupler::identity {
namespace {

std::array<std::uint16_t, head_size> area_of(const Head& head) {
  std::array<std::uint16_t, head_size> area{};
  write_head(head, area.data());
  return area;
}

TEST(Identity, The_head_stands_in_the_area_as_documented) {
  const auto area = area_of({0x0123456789ABCDEF, 0x00010203, 0xF409A1FE});
  const std::array<std::uint16_t, head_size> expected{0x4F43, 0x504C,  // "OCPL"
                                                      1,               // layout
                                                      0x0123, 0x4567, 0x89AB, 0xCDEF,
                                                      0x0001, 0x0203, 0xF409, 0xA1FE};
  EXPECT_EQ(area, expected);
}

TEST(Identity, What_is_written_is_read_again) {
  const Head head = head_of(test::map_of(test::sample_points())->map());
  const auto again = read_head(area_of(head));
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->fingerprint, 0xb3aaa998215aab0fU);
  EXPECT_EQ(again->map_size, 12U);
  EXPECT_EQ(again->map_crc, 0xF409A1FEU) << "zlib.crc32(b'name: press\\n')";
}

TEST(Identity, Without_the_magic_or_with_another_layout_it_is_a_foreign_coupler) {
  EXPECT_FALSE(read_head({}).has_value());
  auto other_layout = area_of({});
  other_layout[at_layout] = 2;
  EXPECT_FALSE(read_head(other_layout).has_value());
  auto other_magic = area_of({});
  other_magic[at_magic + 1] ^= 1;
  EXPECT_FALSE(read_head(other_magic).has_value());
}

/// The area as a node fills it.
std::vector<std::uint16_t> whole_area(const Machine& machine) {
  std::vector<std::uint16_t> area(size);
  write_head({0x0123456789ABCDEF, 0, 0}, area.data());
  write_further({machine, {true, false}, 0x00012345}, area.data());
  return area;
}

Further further_of(const std::vector<std::uint16_t>& area, std::size_t registers) {
  return read_further({area.data() + at_serial, registers});
}

Machine machine_in(const std::vector<std::uint16_t>& area, std::size_t registers) {
  return further_of(area, registers).machine;
}

TEST(Identity, The_machine_stands_behind_the_statistics_as_documented) {
  const auto area = whole_area(machine_of("cell-7", 0x0011223344556677));
  ASSERT_EQ(area.size(), 85U);
  const std::vector<std::uint16_t> further(area.begin() + 45, area.begin() + 54);
  EXPECT_EQ(further,
            (std::vector<std::uint16_t>{39, 0x0011, 0x2233, 0x4455, 0x6677, 0x6365, 0x6C6C, 0x2D37, 0}));
}

TEST(Identity, A_machine_that_is_written_is_read_again) {
  for (const std::string& name : {std::string(), std::string("a"), std::string(64, 'x')}) {
    const Machine again = machine_in(whole_area(machine_of(name, 7)), further_size);
    EXPECT_EQ(hostname_of(again), name);
    EXPECT_EQ(again.serial, 7U);
  }
}

TEST(Identity, What_the_node_can_do_and_its_watchdogs_timeout_stand_behind_the_machine) {
  auto area = whole_area(machine_of("cell-7", 7));
  EXPECT_EQ((std::vector<std::uint16_t>{area.begin() + 82, area.end()}),
            (std::vector<std::uint16_t>{1, 1, 0x2345}));
  EXPECT_TRUE(further_of(area, further_size).functions.tells_changes);
  EXPECT_FALSE(further_of(area, further_size).functions.schedules_outputs);
  EXPECT_EQ(further_of(area, further_size).watchdog_timeout, 0x12345U);
  EXPECT_EQ(further_of(area, further_size - 1).watchdog_timeout, 0U) << "a part of it";
  area[at_functions] = 0xFFFE;
  EXPECT_FALSE(further_of(area, further_size).functions.tells_changes);
  EXPECT_TRUE(further_of(area, further_size).functions.schedules_outputs);
}

TEST(Identity, A_node_without_these_fields_can_none_of_it) {
  const Further further = further_of(whole_area(machine_of("cell-7", 7)), 36);
  EXPECT_FALSE(further.functions.tells_changes);
  EXPECT_EQ(further.watchdog_timeout, 0U);
  EXPECT_EQ(hostname_of(further.machine), "cell-7");
}

TEST(Identity, A_hostname_that_is_too_long_is_cut_off) {
  EXPECT_EQ(hostname_of(machine_of(std::string(65, 'x'), 0)), std::string(64, 'x'));
}

TEST(Identity, Further_fields_that_are_not_there_are_unknown_and_those_that_nobody_knows_are_ignored) {
  auto area = whole_area(machine_of("cell-7", 7));
  EXPECT_EQ(machine_in(area, 0).serial, 0U);
  EXPECT_EQ(machine_in(area, 3).serial, 0U) << "a part of it";
  EXPECT_EQ(machine_in(area, 4).serial, 7U);
  EXPECT_EQ(hostname_of(machine_in(area, 4)), "");
  EXPECT_EQ(hostname_of(machine_in(area, 5)), "ce");
  area.resize(200, 0xFFFF);
  const Machine machine = machine_in(area, 100);
  EXPECT_EQ(hostname_of(machine), "cell-7");
  EXPECT_EQ(machine.serial, 7U);
}

TEST(Identity, The_report_holds_each_counter_of_the_area_once) {
  std::array<std::uint16_t, report_size> area{};
  write_head({1, 2, 3}, area.data());
  for (std::uint16_t at = head_size; at < report_size; ++at) area[at] = at;
  area[at_watchdog_state] = 2;
  area[at_watchdog_left] = 345;
  const auto report = read_report(area);
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(report->head.map_crc, 3U);
  EXPECT_EQ(report->watchdog_state, 2);
  EXPECT_EQ(report->watchdog_left, 345);
  EXPECT_EQ(report->uptime, 13U << 16U | 14U);
  std::set<std::uint32_t> counts;
  for (const Counter& each : counters) counts.insert(report->counts.*each.count);
  std::set<std::uint32_t> expected;
  for (std::uint32_t at = at_uptime + 2; at < report_size; at += 2) expected.insert(at << 16U | (at + 1));
  EXPECT_EQ(counts, expected);
  area[at_layout] = 2;
  EXPECT_FALSE(read_report(area).has_value());
}

TEST(Identity, A_piece_of_the_map_stays_in_its_file_and_in_the_text) {
  constexpr std::uint32_t size = 50000;  // bytes: 25000 records, two and a half files
  const auto expect = [](std::uint32_t first, std::uint32_t file, std::uint32_t record,
                         std::uint32_t registers) {
    const FileRecord piece = record_at(first, size);
    EXPECT_EQ(piece.file, file) << first;
    EXPECT_EQ(piece.record, record) << first;
    EXPECT_EQ(piece.registers, registers) << first;
  };
  expect(0, 1, 0, 121);
  expect(9879, 1, 9879, 121);
  expect(9999, 1, 9999, 1);
  expect(10000, 2, 0, 121);
  expect(20000, 3, 0, 121);
  expect(24990, 3, 4990, 10);
}

TEST(Identity, An_odd_last_byte_has_a_record_of_its_own) {
  EXPECT_EQ(record_at(0, 1).registers, 1);
  EXPECT_EQ(record_at(0, 3).registers, 2);
}

TEST(Identity, The_pieces_of_a_map_make_the_whole) {
  constexpr std::uint32_t size = 45001;
  std::uint32_t first = 0;
  while (first < (size + 1) / 2) {
    const FileRecord piece = record_at(first, size);
    ASSERT_GT(piece.registers, 0);
    ASSERT_EQ((piece.file - 1U) * modbus::records_per_file + piece.record, first);
    first += piece.registers;
  }
  EXPECT_EQ(first, (size + 1) / 2);
}

}  // namespace
}  // namespace coupler::identity
