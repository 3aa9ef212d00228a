// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/histogram.hpp"

#include <gtest/gtest.h>

namespace coupler::host {
namespace {

using std::chrono::microseconds;
using std::chrono::seconds;

TEST(Histogram, Without_durations_all_is_zero) {
  const Histogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), Duration::zero());
  EXPECT_EQ(histogram.max(), Duration::zero());
}

TEST(Histogram, Quantiles_are_at_most_an_eighth_above_the_truth) {
  for (const std::int64_t scale : {1, 7, 100, 3000}) {
    Histogram histogram;
    for (int i = 1; i <= 1000; ++i) histogram.add(microseconds(i * scale));
    for (const double share : {0.5, 0.95, 0.99}) {
      const double truth = share * 1000 * static_cast<double>(scale);
      const auto told = std::chrono::duration<double, std::micro>(histogram.quantile(share)).count();
      EXPECT_GE(told, truth);
      EXPECT_LE(told, truth * 1.125 + 1) << scale << " " << share;
    }
    EXPECT_EQ(histogram.max(), microseconds(1000 * scale));
  }
}

TEST(Histogram, What_is_too_long_for_it_is_still_counted) {
  Histogram histogram;
  histogram.add(seconds(100000));
  histogram.add(Duration(-5));
  EXPECT_EQ(histogram.count(), 2U);
  EXPECT_EQ(histogram.max(), seconds(100000));
}

}  // namespace
}  // namespace coupler::host
