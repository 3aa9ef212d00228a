// SPDX-License-Identifier: Apache-2.0
// The codec against test/golden/codec.json, whose numbers come from Python's struct and pymodbus.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>

#include <nlohmann/json.hpp>

#include "coupler/codec/type_name.hpp"
#include "coupler/codec/value.hpp"
#include "test/support/paths.hpp"

namespace coupler::codec {
namespace {

using nlohmann::json;

json read_cases() {
  std::ifstream file(test::in_tree("test/golden/codec.json"));
  return json::parse(file);
}

Encoding encoding_of(const std::string& name) {
  if (name == "ascii") return Encoding::ascii;
  return name == "latin-1" ? Encoding::latin1 : Encoding::utf8;
}

Format format_of(const json& c) {
  Format f;
  f.type = parse_type(c.at("type").get<std::string>()).value();
  if (f.type == Type::STRING) {
    f.order = c.at("ignore_byteorder").get<bool>() ? Order::ABCD : Order::BADC;
    f.length = c.at("length").get<std::uint16_t>();
    f.encoding = encoding_of(c.at("encoding"));
    return f;
  }
  f.order = parse_word<Order>(c.at("order").get<std::string>()).value();
  f.half = c.value("offset", "high") == "low" ? Half::low : Half::high;
  f.bit = c.value("bit", std::uint8_t{0});
  return f;
}

Value value_of(const json& c, Type type) {
  const json& v = c.at("value");
  if (type == Type::REAL) return std::strtof(v.get<std::string>().c_str(), nullptr);
  if (type == Type::LREAL) return std::strtod(v.get<std::string>().c_str(), nullptr);
  if (type == Type::STRING) return v.get<std::string>();
  if (type == Type::BOOL) return v.get<bool>();
  if (type == Type::SINT || type == Type::INT || type == Type::DINT || type == Type::LINT)
    return v.get<std::int64_t>();
  return v.get<std::uint64_t>();
}

bool is_nan(const Value& v) {
  if (const auto* f = std::get_if<float>(&v)) return std::isnan(*f);
  if (const auto* d = std::get_if<double>(&v)) return std::isnan(*d);
  return false;
}

TEST(GoldenCodec, Registers_decode_to_the_value) {
  for (const json& c : read_cases()) {
    SCOPED_TRACE(c.dump());
    const Format format = format_of(c);
    const auto registers = c.at("registers").get<std::vector<std::uint16_t>>();
    ASSERT_EQ(registers.size(), codec::registers(format));
    const Value expected = value_of(c, format.type);
    const Value seen = decode(registers.data(), format);
    ASSERT_EQ(seen.index(), expected.index());
    if (is_nan(expected)) {
      EXPECT_TRUE(is_nan(seen));
    } else {
      EXPECT_EQ(seen, expected);
      if (const auto* f = std::get_if<float>(&seen)) {
        EXPECT_EQ(std::signbit(*f), std::signbit(std::get<float>(expected)));
      }
    }
  }
}

TEST(GoldenCodec, The_value_encodes_to_the_registers_and_leaves_other_bits_alone) {
  for (const json& c : read_cases()) {
    SCOPED_TRACE(c.dump());
    const Format format = format_of(c);
    const auto expected = c.at("registers").get<std::vector<std::uint16_t>>();
    auto registers = c.value("background", std::vector<std::uint16_t>(expected.size(), 0xFFFF));
    const auto result = encode(value_of(c, format.type), format, registers.data());
    ASSERT_TRUE(result) << result.error();
    EXPECT_EQ(registers, expected);
  }
}

TEST(GoldenCodec, Every_type_in_every_order_has_vectors) {
  std::set<std::pair<std::string, std::string>> seen;
  for (const json& c : read_cases()) seen.emplace(c.at("type"), c.value("order", "-"));
  EXPECT_EQ(seen.size(), 3U * 2 + 8U * 4 + 4U * 2 + 2U + 1U);
}

}  // namespace
}  // namespace coupler::codec
