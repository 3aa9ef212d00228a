// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace coupler::loader {
namespace {

TEST(Keys, No_section_has_a_name_twice) {
  const auto all = all_keys();
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = i + 1; k < all.size(); ++k)
      EXPECT_FALSE(all[i].name == all[k].name && overlap(all[i].sections, all[k].sections)) << all[i].name;
}

TEST(Keys, Every_key_is_described_with_an_example) {
  for (const Key& key : all_keys()) {
    EXPECT_NE(key.sections, Section::none) << key.name;
    EXPECT_FALSE(key.example.empty()) << key.name;
    EXPECT_FALSE(key.summary.empty()) << key.name;
    EXPECT_EQ(key.kind == ValueKind::choice || key.kind == ValueKind::type, !key.choices.empty()) << key.name;
    EXPECT_LE(key.least, key.most) << key.name;
  }
}

TEST(Keys, The_example_of_a_choice_is_one_of_its_words) {
  for (const Key& key : all_keys()) {
    if (key.choices.empty()) continue;
    const auto choices = words(key.choices);
    EXPECT_NE(std::find(choices.begin(), choices.end(), key.example), choices.end()) << key.name;
  }
}

TEST(Keys, What_holds_otherwise_is_a_value_that_one_may_write) {
  for (const Key& key : all_keys()) {
    if (key.fallback.empty()) continue;
    EXPECT_FALSE(key.required) << key.name;
    const auto choices = words(key.choices);
    EXPECT_TRUE(choices.empty() || std::find(choices.begin(), choices.end(), key.fallback) != choices.end())
        << key.name;
  }
}

TEST(Keys, What_has_keys_inside_says_which) {
  for (const Key& key : all_keys()) {
    const bool container =
        key.kind == ValueKind::section || key.kind == ValueKind::points || key.kind == ValueKind::named;
    EXPECT_TRUE(!container || key.inside != Section::none) << key.name;
    EXPECT_TRUE(!key.several || key.inside != Section::none) << key.name;
  }
}

TEST(Keys, A_key_for_some_types_names_types_that_there_are) {
  const Key* type = find_key("type", Section::input_register);
  const auto types = words(type->choices);
  for (const Key& key : all_keys())
    for (const std::string_view word : words(key.types))
      EXPECT_NE(std::find(types.begin(), types.end(), word), types.end()) << key.name;
  EXPECT_TRUE(applies_to(*find_key("length", Section::input_register), "STRING"));
  EXPECT_FALSE(applies_to(*find_key("length", Section::input_register), "INT"));
  EXPECT_TRUE(applies_to(*find_key("order", Section::input_register), "INT"));
}

TEST(Keys, Another_spelling_belongs_to_the_same_section) {
  for (const Key& key : all_keys())
    EXPECT_TRUE(key.same_as.empty() || find_key(key.same_as, key.sections) != nullptr) << key.name;
}

TEST(Keys, A_key_is_found_only_where_it_belongs) {
  EXPECT_EQ(find_key("drive", Section::discrete_input), nullptr);
  EXPECT_NE(find_key("drive", Section::coil_line), nullptr);
  EXPECT_EQ(sections_with("debounce"), Section::discrete_input | Section::input_line);
  EXPECT_EQ(sections_with("nothing"), Section::none);
  for (const Table table : tables) EXPECT_NE(find_key("address", section_of(table)), nullptr);
}

}  // namespace
}  // namespace coupler::loader
