// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/figures/histogram.hpp"

#include <gtest/gtest.h>

namespace zonepack {
namespace {

TEST(Histogram, TellsPercentilesAtMostThreePercentTooHigh) {
  Histogram histogram;
  for (std::int64_t ns = 1; ns <= 100'000; ++ns) histogram.add(ns);
  for (const double share : {0.001, 0.5, 0.99, 0.9999}) {
    const double exact = share * 100'000;
    EXPECT_GE(static_cast<double>(histogram.percentile(share)), exact);
    EXPECT_LE(static_cast<double>(histogram.percentile(share)), exact * 1.032);
  }
  EXPECT_EQ(histogram.figures().max, 100'000);
  EXPECT_EQ(histogram.figures().count, 100'000u);
}

TEST(Histogram, KeepsSmallValuesApart) {
  Histogram histogram;
  for (const std::int64_t ns : {3, 4, 5}) histogram.add(ns);
  EXPECT_EQ(histogram.percentile(0.5), 4);
  EXPECT_EQ(histogram.percentile(1), 5);
}

TEST(Histogram, TakesAnyValueAndSaysNothingOfNone) {
  Histogram histogram;
  EXPECT_EQ(histogram.percentile(0.5), 0);
  histogram.add(-5);
  histogram.add(INT64_MAX);
  EXPECT_EQ(histogram.percentile(0.5), 0);
  EXPECT_EQ(histogram.figures().max, INT64_MAX);
}

}  // namespace
}  // namespace zonepack
