// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

/// A map with the wired input "button" and one more point, "p".
MapPtr with_point(const std::string& table, const std::string& options) {
  return test::load_clean(
      "name: press\nmapping:\n  discrete_inputs: {button: {address: 0, line: GPIO17}}\n  " + table +
      ": {p: " + options + "}\n");
}

const Point& p_of(const MapPtr& owned) {
  static const Point none;
  const Point* found = find(owned->map(), "p");
  EXPECT_NE(found, nullptr);
  return found == nullptr ? none : *found;
}

TEST(Edges, A_counter_counts_the_rising_edges_by_default) {
  const MapPtr owned = with_point("input_registers", "{address: 0, type: UDINT, counter: {of: button}}");
  EXPECT_EQ(p_of(owned).counter.input, "button");
  EXPECT_EQ(p_of(owned).counter.edge, Edge::rising);
  EXPECT_FALSE(p_of(owned).latched.present());
}

TEST(Edges, Every_whole_number_of_registers_counts_in_both_tables) {
  for (const char* type : {"INT", "UINT", "DINT", "UDINT", "LINT", "ULINT"})
    for (const char* table : {"input_registers", "holding_registers"}) {
      const MapPtr owned = with_point(
          table, std::string("{address: 0, type: ") + type + ", counter: {of: button, edge: both}}");
      EXPECT_EQ(p_of(owned).counter.edge, Edge::both) << type;
    }
}

TEST(Edges, A_coil_and_a_bit_can_be_latched) {
  const MapPtr coil = with_point("coils", "{address: 0, latched: {of: button, edge: falling}}");
  EXPECT_EQ(p_of(coil).latched.input, "button");
  EXPECT_EQ(p_of(coil).latched.edge, Edge::falling);
  const MapPtr bit =
      with_point("holding_registers", "{address: 0, type: BOOL, bit: 3, latched: {of: button}}");
  EXPECT_EQ(p_of(bit).latched.edge, Edge::rising);
}

TEST(Edges, A_simulated_wire_makes_edges_without_a_line) {
  const MapPtr owned = test::load_clean(
      "name: press\n"
      "mapping: {discrete_inputs: {pulse: 0}, coils: {p: {address: 0, latched: {of: pulse}}}}\n"
      "sim: [{to: pulse, square: 1s}]\n");
  EXPECT_EQ(p_of(owned).latched.input, "pulse");
}

TEST(Edges, The_fingerprint_does_not_know_them) {
  const MapPtr counter = with_point("input_registers", "{address: 0, type: UINT, counter: {of: button}}");
  const MapPtr memory = with_point("input_registers", "{address: 0, type: UINT}");
  EXPECT_EQ(counter->map().fingerprint, memory->map().fingerprint);
}

TEST(Access, A_table_that_can_be_written_is_read_and_written_by_default) {
  EXPECT_EQ(test::OnePoint("coils", "{address: 0}")->access, Access::read_write);
  EXPECT_EQ(test::OnePoint("coils", "{address: 0, access: read}")->access, Access::read);
  EXPECT_EQ(test::OnePoint("holding_registers", "{address: 0, type: INT, access: write}")->access,
            Access::write);
  EXPECT_EQ(test::OnePoint("input_registers", "{address: 0, type: INT, access: read}")->access, Access::read);
}

TEST(Access, One_that_reads_and_one_that_writes_may_share_an_address) {
  const LoadResult result = load_map(
      test::map_of("holding_registers",
                   "actual: {address: 0, type: INT, access: read}, wanted: {address: 0, type: INT, access: "
                   "write}"),
      "map.yaml");
  EXPECT_NE(result.map, nullptr);
  EXPECT_TRUE(result.diagnostics.empty());
}

}  // namespace
}  // namespace coupler
