// SPDX-License-Identifier: Apache-2.0
#include "coupler/codec/decimal.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace coupler::codec {
namespace {

using Float = std::numeric_limits<float>;
using Double = std::numeric_limits<double>;

TEST(Decimal, Has_the_fewest_digits_that_tell_the_number_of_its_type) {
  EXPECT_EQ(decimal(0.1), "0.1");
  EXPECT_EQ(decimal(0.1F), "0.1");
  EXPECT_EQ(decimal(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(decimal(-1234.5625), "-1234.5625");
  EXPECT_EQ(decimal(Double::max()), "1.7976931348623157e308");
  EXPECT_EQ(decimal(Double::denorm_min()), "5.0e-324");
  EXPECT_EQ(decimal(Float::max()), "3.4028235e38");
}

TEST(Decimal, Always_looks_like_a_float) {
  EXPECT_EQ(decimal(0.0), "0.0");
  EXPECT_EQ(decimal(-0.0), "-0.0");
  EXPECT_EQ(decimal(20.0), "20.0");
  EXPECT_EQ(decimal(16777216.0F), "16777216.0");
}

TEST(Decimal, Has_an_exponent_where_zeros_would_be_many) {
  EXPECT_EQ(decimal(1e15), "1000000000000000.0");
  EXPECT_EQ(decimal(1e16), "1.0e16");
  EXPECT_EQ(decimal(0.00001), "0.00001");
  EXPECT_EQ(decimal(0.000001), "1.0e-6");
}

}  // namespace
}  // namespace coupler::codec
