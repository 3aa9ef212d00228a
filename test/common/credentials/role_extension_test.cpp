// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "coupler/credentials/role_extension.hpp"

namespace coupler {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes utf8_string(const std::string& text) {
  Bytes bytes{0x0C, static_cast<std::uint8_t>(text.size())};
  bytes.insert(bytes.end(), text.begin(), text.end());
  return bytes;
}

void expect_refused(const Bytes& bytes) { EXPECT_FALSE(parse_role(bytes)) << testing::PrintToString(bytes); }

TEST(RoleExtension, Is_one_UTF8String) {
  EXPECT_EQ(parse_role(utf8_string("operator")), "operator");
  EXPECT_EQ(parse_role(utf8_string("Bediener für Ständer")), "Bediener für Ständer");
  EXPECT_EQ(parse_role(utf8_string(std::string(64, 'x'))), std::string(64, 'x'));
}

TEST(RoleExtension, Has_no_other_type_length_or_bytes) {
  expect_refused({});
  expect_refused({0x0C});
  expect_refused({0x13, 1, 'a'});           // PrintableString
  expect_refused({0x2C, 3, 0x0C, 1, 'a'});  // constructed
  expect_refused({0x0C, 0x81, 1, 'a'});     // a length that DER writes shorter
  expect_refused({0x0C, 0x80, 'a', 0, 0});  // indefinite
  expect_refused({0x0C, 2, 'a'});           // it ends too early
  expect_refused({0x0C, 1, 'a', 'b'});      // something follows
  expect_refused({0x30, 3, 0x0C, 1, 'a'});  // a list of one
  expect_refused(utf8_string(""));
  expect_refused(utf8_string(std::string(65, 'x')));
  expect_refused(utf8_string(std::string(200, 'x')));
}

TEST(RoleExtension, Is_text_without_control_characters) {
  expect_refused(utf8_string(std::string("a\0b", 3)));
  expect_refused(utf8_string("a\nb"));
  expect_refused(utf8_string("a\x7F"));
  expect_refused(utf8_string("a\xC2\x85"));     // U+0085
  expect_refused(utf8_string("\xC0\xAF"));      // overlong
  expect_refused(utf8_string("\xED\xA0\x80"));  // a surrogate
  expect_refused(utf8_string("a\xC3"));         // cut
}

}  // namespace
}  // namespace coupler
