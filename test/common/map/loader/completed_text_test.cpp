// SPDX-License-Identifier: Apache-2.0
// The text that a node serves of a map that leaves addresses out.
#include <gmock/gmock.h>

#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

using test::renewed;
using test::text_of;

TEST(ServedText, It_has_the_addresses_and_all_else_as_it_was) {
  const auto result = renewed(
      "# A cell\n"
      "name: m\n"
      "mapping:\n"
      "  coils:\n"
      "    a:\n"
      "    b: # the second\n"
      "    c: ~\n"
      "    \"d\": {}\n"
      "    e: {description: left}   # of the door\n"
      "    f: 17\n"
      "  holding_registers:\n"
      "    g:\n"
      "      # wide\n"
      "      type: DINT\n"
      "      units: mm\n"
      "    h: {type: SINT}\n"
      "    i: {type: SINT, offset: low}\n"
      "    j:\n"
      "      type: BOOL\n");
  EXPECT_EQ(result.map->map().text,
            "# A cell\n"
            "name: m\n"
            "mapping:\n"
            "  coils:\n"
            "    a: 0\n"
            "    b: 1 # the second\n"
            "    c: 2\n"
            "    \"d\": {address: 3}\n"
            "    e: {address: 4, description: left}   # of the door\n"
            "    f: 17\n"
            "  holding_registers:\n"
            "    g:\n"
            "      # wide\n"
            "      address: 0\n"
            "      type: DINT\n"
            "      units: mm\n"
            "    h: {address: 2, offset: high, type: SINT}\n"
            "    i: {address: 2, type: SINT, offset: low}\n"
            "    j:\n"
            "      address: 3\n"
            "      bit: 0\n"
            "      type: BOOL\n");
}

TEST(ServedText, It_is_the_file_if_that_leaves_nothing_out) {
  const std::string text = "\xEF\xBB\xBF# with a mark\r\nname: m\r\nmapping: {coils: {a: 0}}\r\n";
  EXPECT_EQ(renewed(text).map->map().text, text);
}

TEST(ServedText, A_map_that_it_would_be_too_long_for_is_refused) {
  const std::string map = "name: m\nmapping: {coils: {a: }}\n#";
  const std::string longest = map + std::string((std::size_t{16} << 20U) - map.size(), '#');
  const auto result = test::load_with_lock(longest, LockUse::renew);
  EXPECT_EQ(result.map, nullptr);
  EXPECT_THAT(text_of(result.diagnostics),
              testing::StartsWith("m.yaml:2:19: error: the addresses that the map leaves out cannot be "
                                  "filled in (the file has 16777218 bytes"));
}

struct Form {
  std::string text;
  std::string served;
};

class ServedForm : public testing::TestWithParam<Form> {};

TEST_P(ServedForm, Is_the_same_map_without_a_lock) {
  const auto result = renewed(GetParam().text);
  ASSERT_NE(result.map, nullptr);
  EXPECT_EQ(result.map->map().text, GetParam().served);
  const MapPtr again = test::load_clean(std::string(result.map->map().text));
  EXPECT_EQ(again->map().fingerprint, result.map->map().fingerprint);
  EXPECT_EQ(again->map().text, result.map->map().text);
}

INSTANTIATE_TEST_SUITE_P(
    Forms, ServedForm,
    testing::Values(
        Form{R"({"name": "m", /* a { */ "mapping": {"coils": {"a" /* : */ : /* b */ null, "b": {}},
  "holding_registers": {"c": {"type": "SINT"}, // c
   "d": {"type": "BOOL",},}}})",
             R"({"name": "m", /* a { */ "mapping": {"coils": {"a" /* : */ : /* b */ 0, "b": {"address": 1}},
  "holding_registers": {"c": {"address": 0, "offset": "high", "type": "SINT"}, // c
   "d": {"address": 0, "bit": 0, "type": "BOOL",},}}})"},
        Form{"\xEF\xBB\xBF{\"name\": \"m\", \"mapping\": {\"coils\": {\"a\": null}}}",
             "{\"name\": \"m\", \"mapping\": {\"coils\": {\"a\": 0}}}"},
        Form{"name: m\r\nmapping:\r\n  coils:\r\n    a:\r\n    b:\r\n      units: x\r\n",
             "name: m\r\nmapping:\r\n  coils:\r\n    a: 0\r\n    b:\r\n      address: 1\n      units: x\r\n"},
        Form{"name: m\n\t\nmapping:\n  coils:\n    a:\n \t \n    b:\n\t# c\n\t",
             "name: m\n\t\nmapping:\n  coils:\n    a: 0\n \t \n    b: 1\n\t# c\n\t"},
        Form{"name: m\nmapping: {coils: {a: , 'b': , c: NULL}}",
             "name: m\nmapping: {coils: {a: 0 , 'b': 1 , c: 2}}"},
        Form{
            "name: m\nmapping:\n  coils:\n    ? a\n    : units: x\n      count: 2\n    b:\n      ? units\n   "
            "   : y\n",
            "name: m\nmapping:\n  coils:\n    ? a\n    : address: 0\n      units: x\n      count: 2\n    b:\n"
            "      address: 2\n      ? units\n      : y\n"},
        Form{"name: m\naddressing: modicon\nmapping: {coils: {a: }, holding_registers: {b: {type: INT}}}",
             "name: m\naddressing: modicon\nmapping: {coils: {a: 000001 }, holding_registers: {b: {address: "
             "400001, "
             "type: INT}}}"}));

}  // namespace
}  // namespace coupler
