// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/nearest.hpp"

#include <gtest/gtest.h>

namespace coupler {
namespace {

TEST(Nearest, Edits_are_insertions_deletions_replacements_and_swaps) {
  EXPECT_EQ(edit_distance("unit", "unit"), 0U);
  EXPECT_EQ(edit_distance("", "unit"), 4U);
  EXPECT_EQ(edit_distance("unt", "unit"), 1U);
  EXPECT_EQ(edit_distance("unnit", "unit"), 1U);
  EXPECT_EQ(edit_distance("unot", "unit"), 1U);
  EXPECT_EQ(edit_distance("unti", "unit"), 1U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
}

TEST(Nearest, A_typing_mistake_finds_the_word_that_was_meant) {
  EXPECT_EQ(nearest("adress", {"name", "address", "port"}), "address");
  EXPECT_EQ(nearest("adres", {"name", "address", "port"}), "address") << "doubled letters count once";
  EXPECT_EQ(nearest("valve_1", {"valve_111"}), "") << "doubled digits do";
  EXPECT_EQ(nearest("UNIT", {"INT", "UINT", "unit"}), "unit") << "case does not count";
  EXPECT_EQ(nearest("registers_read_seperation_gap", {"registers_read_separation_gap"}),
            "registers_read_separation_gap");
}

TEST(Nearest, All_that_differ_least_are_found) {
  using Words = std::vector<std::string_view>;
  EXPECT_EQ(all_nearest("ULNT", {"INT", "UINT", "ULINT"}), (Words{"UINT", "ULINT"}));
  EXPECT_EQ(all_nearest("colour", {"name", "port"}), Words{});
}

TEST(Nearest, A_slip_is_one_letter_and_more_in_long_words) {
  EXPECT_TRUE(is_slip("scael", "scale"));
  EXPECT_TRUE(is_slip("Discrete Inputs", "discrete_inputs"));
  EXPECT_FALSE(is_slip("note", "rate")) << "two of four letters";
  EXPECT_FALSE(is_slip("f", "of"));
  EXPECT_FALSE(is_slip(std::string(100000, 'a'), "name"));
}

TEST(Nearest, The_opposite_is_never_suggested) {
  EXPECT_EQ(nearest("no", {"off", "on", "hold"}), "");
  EXPECT_EQ(nearest("of", {"off", "on", "hold"}), "") << "as near to the one as to the other";
  EXPECT_EQ(nearest("offf", {"off", "on", "hold"}), "off");
  EXPECT_EQ(nearest("enabled", {"as_is", "disabled"}), "");
  EXPECT_EQ(nearest("active_hi", {"active_low"}), "");
  EXPECT_EQ(nearest("unlatched", {"latched"}), "");
  EXPECT_EQ(nearest("latched", {"unlatched"}), "");
  EXPECT_EQ(nearest("heater_off", {"heater_on", "heater_oft"}), "heater_oft");
  EXPECT_EQ(nearest("inital", {"initial"}), "initial") << "begins with 'in' and denies nothing";
  EXPECT_EQ(nearest("unti", {"unit"}), "unit");
  EXPECT_FALSE(is_slip("unlatched", "latched"));
}

TEST(Nearest, Nothing_is_suggested_for_another_word) {
  EXPECT_EQ(nearest("colour", {"name", "address", "port"}), "");
  EXPECT_EQ(nearest("x", {"to"}), "");
  EXPECT_EQ(nearest(std::string(100000, 'a'), {"name"}), "");
  EXPECT_EQ(nearest("note", {"rate"}), "") << "two of four letters";
  EXPECT_EQ(nearest("latch", {"latched"}), "");
  EXPECT_EQ(nearest("counter", {"count"}), "");
  EXPECT_EQ(nearest("scale", {"safe"}), "");
  EXPECT_EQ(nearest("invalid", {"initial"}), "");
  EXPECT_EQ(suggestion("colour", {"to", "from"}), "write one of to, from");
  EXPECT_EQ(suggestion("form", {"to", "from"}), "did you mean 'from'?");
}

}  // namespace
}  // namespace coupler
