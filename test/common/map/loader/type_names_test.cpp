// SPDX-License-Identifier: Apache-2.0
// Types under the names that people know them by, and how a map with them is served.
#include <gtest/gtest.h>

#include "coupler/codec/type_name.hpp"
#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

using codec::Type;

std::string with_type(std::string_view type, const std::string& more) {
  return test::map_of("holding_registers", "p: {address: 0, type: " + std::string(type) + more + "}");
}

/// What else a point of that type needs.
std::string needs(Type type) {
  if (type == Type::STRING) return ", length: 4";
  if (type == Type::BOOL) return ", bit: 0";
  return codec::width(type) == 8 ? ", offset: low" : "";
}

TEST(TypeNames, Each_is_read_as_its_type_with_the_same_fingerprint) {
  for (const codec::TypeName& other : codec::other_type_names()) {
    const MapPtr named = test::load_clean(with_type(other.name, needs(other.type)));
    const MapPtr iec = test::load_clean(with_type(to_string(other.type), needs(other.type)));
    EXPECT_EQ(named->map().fingerprint, iec->map().fingerprint) << other.name;
  }
}

TEST(TypeNames, One_with_two_meanings_is_an_error_that_names_both) {
  for (const codec::AmbiguousTypeName& each : codec::ambiguous_type_names()) {
    const LoadResult result = load_map(with_type(each.name, ""), "m");
    ASSERT_EQ(result.diagnostics.size(), 1U) << each.name;
    for (const Type type : {each.one, each.other})
      EXPECT_NE(result.diagnostics[0].remedy.find(std::string(to_string(type)) + " ("), std::string::npos)
          << each.name;
  }
}

/// Every name of a type with a slip in its letters; the number in it is left alone.
TEST(TypeNames, A_remedy_never_has_another_width_than_the_number_in_the_name) {
  for (const codec::TypeName& other : codec::other_type_names()) {
    const std::size_t digit = other.name.find_first_of("0123456789");
    if (digit == std::string_view::npos) continue;
    for (std::size_t i = 0; i < other.name.size(); ++i) {
      std::string slip(other.name);
      if (slip[i] >= '0' && slip[i] <= '9') continue;
      slip[i] = 'q';
      for (const Diagnostic& problem : load_map(with_type(slip, ""), "m").diagnostics) {
        const std::string mark = "did you mean '";
        if (problem.remedy.compare(0, mark.size(), mark) != 0) continue;
        const auto meant =
            codec::parse_type(problem.remedy.substr(mark.size(), problem.remedy.size() - mark.size() - 2));
        ASSERT_TRUE(meant.has_value()) << problem.remedy;
        EXPECT_EQ(codec::width(*meant), codec::width(other.type)) << slip << ": " << problem.remedy;
      }
    }
  }
}

TEST(TypeNames, A_map_is_served_with_the_names_of_IEC_61131_3) {
  EXPECT_EQ(test::load_clean("name: a\n"
                             "mapping:\n"
                             "  holding_registers:\n"
                             "    p: {address: 0, type: uint32}  # as in the manual\n"
                             "    q:\n"
                             "      type: \"float\"\n"
                             "      address: 2\n"
                             "    r: {address: 4, type: uint}\n")
                ->map()
                .text,
            "name: a\n"
            "mapping:\n"
            "  holding_registers:\n"
            "    p: {address: 0, type: UDINT}  # as in the manual\n"
            "    q:\n"
            "      type: \"REAL\"\n"
            "      address: 2\n"
            "    r: {address: 4, type: uint}\n");
  EXPECT_EQ(test::load_clean("{\"name\": \"a\", // x\n\"mapping\": {\"input_registers\": {\"p\": "
                             "{\"type\": \"i16\", \"address\": 0}}}}")
                ->map()
                .text,
            "{\"name\": \"a\", // x\n\"mapping\": {\"input_registers\": {\"p\": {\"type\": \"INT\", "
            "\"address\": 0}}}}");
}

TEST(TypeNames, Addresses_and_types_are_filled_in_together) {
  const LockFile renew{"m.lock", std::nullopt, LockUse::renew};
  const LoadResult result = load_map_with_lock(
      "name: a\nmapping: {holding_registers: {p: {type: u16}, q: {address: 4, type: s16}, r: {type: "
      "double}}}\n",
      "m", renew);
  ASSERT_NE(result.map, nullptr) << test::text_of(result.diagnostics);
  EXPECT_EQ(result.map->map().text,
            "name: a\nmapping: {holding_registers: {p: {address: 0, type: UINT}, q: {address: 4, type: INT}, "
            "r: {address: 8, type: LREAL}}}\n");
}

}  // namespace
}  // namespace coupler
