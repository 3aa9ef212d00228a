// SPDX-License-Identifier: Apache-2.0
#include "coupler/codec/type_name.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace coupler::codec {
namespace {

/// The number in a name, 0 if it has none.
unsigned number_in(std::string_view name) {
  unsigned number = 0;
  for (const char c : name) {
    if (std::isdigit(static_cast<unsigned char>(c)) != 0)
      number = number * 10 + static_cast<unsigned>(c - '0');
    else if (number > 0)
      break;
  }
  return number;
}

TEST(TypeName, Those_of_IEC_61131_3_are_read_in_any_case_and_written_in_capitals) {
  EXPECT_EQ(parse_type("lreal"), Type::LREAL);
  EXPECT_EQ(parse_type("Udint"), Type::UDINT);
  EXPECT_EQ(to_string(Type::UDINT), "UDINT");
  for (const Word<Type>& each : enumeration_of<Type>.words) EXPECT_EQ(parse_type(each.word), each.value);
}

TEST(TypeName, The_number_in_another_name_is_the_width_of_its_type) {
  for (const TypeName& other : other_type_names()) {
    const unsigned number = number_in(other.name);
    EXPECT_TRUE(number == 0 || number == width(other.type)) << other.name;
  }
}

TEST(TypeName, A_name_means_one_type_or_is_ambiguous_and_is_never_one_of_IEC_61131_3) {
  std::set<std::string> seen;
  for (const Word<Type>& each : enumeration_of<Type>.words) seen.insert(folded_type_name(each.word));
  for (const TypeName& other : other_type_names())
    EXPECT_TRUE(seen.insert(other.name.find('_') == std::string_view::npos ? folded_type_name(other.name)
                                                                           : std::string(other.name))
                    .second)
        << other.name;
  for (const AmbiguousTypeName& each : ambiguous_type_names()) {
    EXPECT_TRUE(seen.insert(std::string(each.name)).second) << each.name;
    EXPECT_EQ(each.name, folded_type_name(each.name)) << "how it is looked up";
    EXPECT_EQ(parse_type(each.name), std::nullopt);
  }
}

/// What these manuals say: C (ISO/IEC 9899, 7.20), C#'s language reference, OPC servers' lists of data types
/// (Kepware), Schneider's PM5000, SunSpec's information model, CANopen (CiA 301), IEEE 754 (binary32,
/// binary64).
TEST(TypeName, Names_of_other_languages_have_the_width_that_their_manuals_say) {
  struct Said {
    std::string_view name;
    unsigned bits;
    char kind;  // 's'igned, 'u'nsigned, 'f'loating point, 'b'its
  };
  for (const auto& [name, bits, kind] :
       {Said{"int32_t", 32, 's'}, Said{"uint8_t", 8, 'u'}, Said{"sbyte", 8, 's'}, Said{"Short", 16, 's'},
        Said{"ushort", 16, 'u'}, Said{"INT16U", 16, 'u'}, Said{"bitfield32", 32, 'b'}, Said{"acc64", 64, 'u'},
        Said{"UNSIGNED32", 32, 'u'}, Said{"float", 32, 'f'}, Said{"double", 64, 'f'},
        Said{"Unsigned 16", 16, 'u'}, Said{"QWord", 64, 'b'}, Said{"Single", 32, 'f'}, Said{"u64", 64, 'u'},
        Said{"Boolean", 1, 'b'}, Said{"bit", 1, 'b'}, Said{"s16", 16, 's'}}) {
    const auto type = parse_type(name);
    ASSERT_TRUE(type.has_value()) << name;
    EXPECT_EQ(width(*type), bits) << name;
    const std::string_view iec = to_string(*type);
    const bool number = iec.find("INT") != std::string_view::npos;
    const bool real = iec.find("REAL") != std::string_view::npos;
    EXPECT_EQ(kind == 'f', real) << name;
    EXPECT_EQ(kind == 's' || kind == 'u', number) << name;
    EXPECT_EQ(kind == 'u', number && iec.front() == 'U') << name;
  }
}

TEST(TypeName, INT_and_CHAR_stay_those_of_IEC_61131_3) {
  EXPECT_EQ(parse_type("int"), Type::INT);
  EXPECT_EQ(parse_type("uint"), Type::UINT);
  EXPECT_EQ(parse_type("char"), Type::CHAR);
}

TEST(TypeName, A_name_with_two_meanings_has_two_widths) {
  for (const AmbiguousTypeName& each : ambiguous_type_names()) EXPECT_LT(width(each.one), width(each.other));
  ASSERT_NE(find_ambiguous_type("Long"), nullptr);
  EXPECT_EQ(find_ambiguous_type("Unsigned Int")->other, Type::UDINT);
  EXPECT_EQ(find_ambiguous_type("dint"), nullptr);
}

}  // namespace
}  // namespace coupler::codec
