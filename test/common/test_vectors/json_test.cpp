// SPDX-License-Identifier: Apache-2.0
#include "coupler/test_vectors/json.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace coupler::test_vectors {
namespace {

using codec::Type;
using Float = std::numeric_limits<float>;
using Double = std::numeric_limits<double>;

TEST(Json, Floats_have_the_digits_of_their_own_type) {
  EXPECT_EQ(json(0.1F, Type::REAL), "0.1");
  EXPECT_EQ(json(-0.0, Type::LREAL), "-0.0");
}

TEST(Json, What_is_no_number_of_json_is_text) {
  EXPECT_EQ(json(Double::quiet_NaN(), Type::LREAL), "\"nan\"");
  EXPECT_EQ(json(Float::infinity(), Type::REAL), "\"inf\"");
  EXPECT_EQ(json(-Float::infinity(), Type::REAL), "\"-inf\"");
}

TEST(Json, Integers_of_64_bits_are_text_for_readers_that_only_know_doubles) {
  EXPECT_EQ(json(std::numeric_limits<std::uint64_t>::max(), Type::ULINT), "\"18446744073709551615\"");
  EXPECT_EQ(json(std::int64_t{-5}, Type::LINT), "\"-5\"");
  EXPECT_EQ(json(std::int64_t{-5}, Type::INT), "-5");
  EXPECT_EQ(json(12.5, Type::LINT), "12.5");  // it has a scale
}

TEST(Json, Names_and_texts_are_escaped) {
  EXPECT_EQ(json(std::string("a\"\n"), Type::STRING), R"("a\"\n")");
  const Map empty{};
  const std::string text = json(empty, "odd\"name.yaml", "1.2");
  EXPECT_NE(text.find(R"("source": "odd\"name.yaml")"), std::string::npos) << text;
  EXPECT_NE(text.find(R"("points": [])"), std::string::npos) << text;
}

}  // namespace
}  // namespace coupler::test_vectors
