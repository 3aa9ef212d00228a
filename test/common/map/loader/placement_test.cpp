// SPDX-License-Identifier: Apache-2.0
// Points without an address: what they get, and what the lock says.
#include <gmock/gmock.h>

#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

using test::load_with_lock;
using test::map_of;
using test::renewed;
using test::text_of;

/// "a 0, b 4": the points in their order, with their addresses and parts.
std::string places(const LoadResult& result) {
  std::string text;
  if (!result.map) return text_of(result.diagnostics);
  for (const Point& point : result.map->map().points) {
    text += (text.empty() ? "" : ", ") + std::string(point.name) + ' ' + std::to_string(point.address);
    if (!is_partial(point)) continue;
    const bool bit = point.format.type == codec::Type::BOOL;
    text += bit                                      ? '.' + std::to_string(point.format.bit)
            : point.format.half == codec::Half::high ? ".high"
                                                     : ".low";
  }
  return text;
}

std::string entries(const std::string& lock) {
  const std::string first = "coupler lock 1\n";
  const std::size_t at = lock.find(first);
  return at == std::string::npos ? lock : lock.substr(at + first.size());
}

/// The lock of those lines.
std::string lock_of(const std::string& lines) { return "coupler lock 1\n" + lines; }

TEST(Placement, Addresses_are_given_by_table_in_the_order_of_the_file) {
  const auto result = renewed(
      "name: m\nmapping:\n  holding_registers: {z: {type: INT}, a: {type: INT}}\n  coils: {y: , x: {}}\n");
  EXPECT_EQ(places(result), "y 0, x 1, z 0, a 1");
  EXPECT_EQ(entries(result.lock.text),
            "coils 0 y\ncoils 1 x\nholding_registers 0 z\nholding_registers 1 a\n");
  EXPECT_EQ(result.lock.path, "m.yaml.lock");
  EXPECT_EQ(result.lock.allocated, (std::vector<std::string>{"z", "a", "y", "x"}));
}

TEST(Placement, Points_with_an_address_come_first) {
  EXPECT_EQ(places(renewed(map_of("coils", "a: , b: 0, c: {count: 3}, d: {address: 3}, e: "))),
            "b 0, a 1, e 2, d 3, c 4");
}

TEST(Placement, Types_are_aligned_and_packed) {
  EXPECT_EQ(places(renewed(map_of("input_registers",
                                  "a: {type: BOOL}, b: {type: LREAL}, c: {type: DINT, count: 3}, d: {type: "
                                  "SINT}, e: {type: BOOL}, f: {type: STRING, length: 5}, g: {type: USINT}"))),
            "d 0.high, a 0.0, e 0.1, f 1, b 4, c 8, g 14.high");
}

TEST(Placement, A_half_or_bit_of_the_file_is_kept) {
  EXPECT_EQ(places(renewed(
                map_of("input_registers",
                       "a: {type: SINT, offset: low}, b: {type: BOOL, bit: 9}, c: {type: BOOL, bit: 9}"))),
            "a 0.low, b 0.9, c 1.9");
}

TEST(Placement, A_lock_names_the_bits_on_the_wire_so_that_another_byte_order_moves_nothing) {
  const std::string points = "a: {type: SINT}, b: {type: BOOL}";
  const auto first = renewed(map_of("input_registers", points));
  EXPECT_EQ(entries(first.lock.text), "input_registers 0.high a\ninput_registers 0.0 b\n");
  const auto reversed =
      renewed(map_of("input_registers", points, "byteorder_reverse: true"), first.lock.text);
  EXPECT_EQ(places(reversed), "a 0.low, b 0.8");
  EXPECT_EQ(reversed.lock.text, "");
}

TEST(Placement, The_initial_value_is_where_the_part_is) {
  const auto result = renewed(map_of("holding_registers", "a: {type: SINT}, b: {type: SINT, initial: 7}"));
  EXPECT_EQ(find(result.map->map(), "b")->initial[0], 0x0007);
}

TEST(Placement, Reserved_and_unreadable_areas_and_those_of_a_node_are_left_out) {
  EXPECT_EQ(places(renewed(map_of("coils", "a: , b: , c: ",
                                  "reserve: [{table: coils, from: 0, to: 3}]\n"
                                  "unreadable: [{table: coils, from: 5, to: 6}]"))),
            "a 4, b 7, c 8");
  const auto full = load_with_lock(map_of("input_registers", "a: {type: INT}, b: {type: INT}",
                                          "reserve: [{table: input_registers, from: 0, to: 0xFEFE}]"),
                                   LockUse::renew);
  EXPECT_EQ(text_of(full.diagnostics),
            "m.yaml:3:45: error: no place is left in input_registers for 'b', which needs 1 register; make "
            "reserved areas smaller, or remove points\n");
}

TEST(Placement, Where_an_output_reads_back_is_left_out) {
  EXPECT_EQ(places(renewed(map_of("holding_registers",
                                  "a: {address: 9, type: INT, read_address: 0}, "
                                  "b: {type: DINT, read_address: 2}, c: {type: INT}"))),
            "c 1, b 4, a 9");
}

TEST(Placement, A_reserved_area_counts_as_the_map_does) {
  EXPECT_EQ(places(renewed(map_of(
                "holding_registers", "a: {type: INT}",
                "addressing: modicon\nreserve: [{table: holding_registers, from: 40001, to: 40010}]"))),
            "a 10");
}

TEST(Placement, A_preset_tells_where_there_is_something) {
  const std::string top = "preset: wago_750\nreserve: [{table: holding_registers, from: 0, to: 510}]";
  // 511 is the last output; from 512 on outputs are read back, and the next area begins at 0x1000.
  EXPECT_EQ(places(renewed(map_of("holding_registers", "a: {type: DINT}, b: {type: INT}", top))),
            "b 511, a 4096");
}

TEST(Placement, An_area_reserved_over_a_point_of_the_lock_is_told) {
  const auto result = load_with_lock(map_of("coils", "a: ", "reserve: [{table: coils, from: 2, to: 4}]"),
                                     LockUse::read, lock_of("coils 3 a\n"));
  EXPECT_EQ(
      text_of(result.diagnostics),
      "m.yaml:3:19: error: 'a' (coils 3) is in the reserved area 2 to 4 (line 2); make the area smaller: "
      "the lock has given the address before\n");
}

TEST(Placement, A_lock_that_is_up_to_date_is_not_written_again) {
  const auto first = renewed(map_of("coils", "a: , b: "));
  const auto second = renewed(map_of("coils", "b: , a: "), first.lock.text);
  EXPECT_EQ(second.lock.text, "");
  EXPECT_EQ(places(second), "a 0, b 1");
  EXPECT_EQ(renewed(map_of("coils", "a: 0")).lock.text, "");
}

TEST(Placement, A_point_that_comes_back_gets_its_old_address) {
  auto lock = renewed(map_of("coils", "a: , b: , c: ")).lock.text;
  const auto without = renewed(map_of("coils", "b: , d: , c: 2"), lock);
  EXPECT_EQ(entries(without.lock.text), "coils 0 a retired\ncoils 1 b\ncoils 2 c retired\ncoils 3 d\n");
  EXPECT_EQ(without.lock.retired, (std::vector<std::string>{"a", "c"}));
  const auto again = renewed(map_of("coils", "c: , a: , b: , d: "), without.lock.text);
  EXPECT_EQ(places(again), "a 0, b 1, c 2, d 3");
  EXPECT_EQ(entries(again.lock.text), "coils 0 a\ncoils 1 b\ncoils 2 c\ncoils 3 d\n");
}

TEST(Placement, A_point_that_goes_to_another_table_leaves_its_place_behind) {
  const auto lock = renewed(map_of("coils", "a: , b: ")).lock.text;
  const auto moved = renewed("name: m\nmapping: {coils: {b: }, discrete_inputs: {a: }}\n", lock);
  EXPECT_EQ(entries(moved.lock.text), "coils 0 a retired\ncoils 1 b\ndiscrete_inputs 0 a\n");
}

TEST(Placement, Who_only_reads_the_lock_needs_all_points_in_it_and_no_more) {
  const std::string lock = lock_of("coils 3 a\ncoils 4 gone\n");
  const auto result = load_with_lock(map_of("coils", "a: "), LockUse::read, lock);
  EXPECT_EQ(text_of(result.diagnostics), "");
  EXPECT_EQ(places(result), "a 3");
  EXPECT_EQ(
      text_of(load_with_lock(map_of("coils", "a: , b: "), LockUse::read, lock_of("coils 3 a\n")).diagnostics),
      "m.yaml:3:24: error: 'b' has no address in m.yaml.lock; run `coupler check m.yaml`, and keep the "
      "new lock beside the map\n");
}

TEST(Placement, A_lock_that_is_not_up_to_date_is_told_to_whom_wants_it_exact) {
  EXPECT_EQ(
      text_of(load_with_lock(map_of("coils", "a: , b: "), LockUse::exact,
                             lock_of("coils 0 a\ncoils 1 b retired\ncoils 2 c\ncoils 3 d retired\n"))
                  .diagnostics),
      "m.yaml.lock:3:1: error: 'b' is a point of the map again; run `coupler check m.yaml`, and commit the "
      "lock\n"
      "m.yaml.lock:4:1: error: the map has no 'c' without an address any more; run `coupler check "
      "m.yaml`, and commit the lock\n");
  EXPECT_NE(load_with_lock(map_of("coils", "a: "), LockUse::exact, lock_of("coils 0 a\n")).map, nullptr);
  EXPECT_EQ(load_with_lock(map_of("coils", "a: "), LockUse::exact).map, nullptr);
}

TEST(Placement, A_map_that_is_no_file_has_no_lock) {
  EXPECT_EQ(text_of(load_map(map_of("coils", "a: "), "<stdin>").diagnostics),
            "<stdin>:3:19: error: 'a' has no address; write 'address: NUMBER'; or put the map into a file: "
            "`coupler check FILE` then gives out addresses and keeps them in FILE.lock\n");
}

TEST(Placement, Whoever_takes_the_address_of_a_retired_point_is_warned) {
  const std::string lock = lock_of("coils 0 a retired\ncoils 1 b retired\n");
  const auto result = load_with_lock(map_of("coils", "b: 1, c: 0"), LockUse::read, lock);
  EXPECT_EQ(text_of(result.diagnostics),
            "m.yaml:3:28: warning: 'c' is at coils 0, where 'a' was (m.yaml.lock, line 2); give it another "
            "address; or delete that line, if no client uses 'a' any more\n");
  EXPECT_NE(result.map, nullptr);
}

TEST(Placement, Numbers_that_the_file_does_not_show_are_not_taken_for_modicons) {
  renewed(map_of("holding_registers", "a: {type: INT}",
                 "reserve: [{table: holding_registers, from: 0, to: 40000}]"));
}

}  // namespace
}  // namespace coupler
