// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/ticks.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace zonepack::report {
namespace {

using Labels = std::vector<std::string>;
constexpr double kTicksNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Ticks, AreRoundNumbers) {
  // 110 / 10 = 11, and the next of 1, 2, 5 times a power of ten is 20.
  EXPECT_EQ(make_ticks(0, 110, 10).labels, (Labels{"0", "20", "40", "60", "80", "100"}));
  EXPECT_EQ(make_ticks(-12.5, 12.5, 5).labels, (Labels{"-10", "-5", "0", "5", "10"}));
  EXPECT_EQ(make_ticks(0, 1, 5).labels, (Labels{"0", "0.2", "0.4", "0.6", "0.8", "1"}));
}

TEST(Ticks, ShowAsManyDigitsAsTheStepNeeds) {
  EXPECT_EQ(make_ticks(0, 0.1, 4).labels, (Labels{"0", "0.05", "0.1"}));
  EXPECT_EQ(make_ticks(0, 0.004, 4).labels, (Labels{"0", "0.001", "0.002", "0.003", "0.004"}));
  EXPECT_EQ(make_ticks(0, 2, 4).labels, (Labels{"0", "0.5", "1", "1.5", "2"}));
}

TEST(Ticks, OfBytesAreRoundInTheirUnit) {
  EXPECT_EQ(make_ticks(0, 4.0 * 1024 * 1024, 4, Quantity::kBytes).labels,
            (Labels{"0", "1 MiB", "2 MiB", "3 MiB", "4 MiB"}));
  EXPECT_EQ(make_ticks(0, 1000, 2, Quantity::kBytes).labels, (Labels{"0", "500 B", "1000 B"}));
}

TEST(Ticks, SurviveEmptyAndHugeAndMeaninglessRanges) {
  for (const auto& [low, high] : {std::pair{0.0, 0.0},
                                  {5.0, 5.0},
                                  {kTicksNaN, 1.0},
                                  {0.0, kTicksNaN},
                                  {2.0, 1.0},
                                  {-1.7e308, 1.7e308},
                                  {0.0, std::numeric_limits<double>::infinity()}}) {
    EXPECT_EQ(make_ticks(low, high, 5).labels, Labels{"0"}) << low << " " << high;
  }
  const Ticks huge = make_ticks(0, 1e300, 5);
  EXPECT_GE(huge.values.size(), 4u);
  EXPECT_LE(huge.values.size(), 7u);
  EXPECT_GE(make_ticks(0, 1e-250, 5).values.size(), 4u);
}

TEST(Ticks, StayInsideTheRangeForManyRanges) {
  for (double high = 1e-6; high < 1e12; high *= 1.37) {
    for (const int wanted : {1, 4, 10}) {
      const Ticks ticks = make_ticks(-high / 3, high, wanted);
      EXPECT_LE(ticks.values.size(), static_cast<std::size_t>(wanted + 1)) << high;
      EXPECT_GE(ticks.values.front(), -high / 3 * (1 + 1e-9));
      EXPECT_LE(ticks.values.back(), high * (1 + 1e-9));
      EXPECT_EQ(std::set<std::string>(ticks.labels.begin(), ticks.labels.end()).size(),
                ticks.labels.size())
          << high;
    }
  }
}

TEST(Ticks, AnAxisEndsAtATickAboveItsData) {
  EXPECT_EQ(round_up_to_tick(1071, 6), 1200);  // 1071 / 6 = 178.5: steps of 200
  EXPECT_EQ(round_up_to_tick(100, 5), 100);
  EXPECT_EQ(round_up_to_tick(0, 5), 1);
  EXPECT_EQ(round_up_to_tick(kTicksNaN, 5), 1);
}

}  // namespace
}  // namespace zonepack::report
