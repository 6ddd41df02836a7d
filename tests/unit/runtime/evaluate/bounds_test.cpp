// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include "runtime/evaluate/interval_packing.hpp"

namespace zonepack {
namespace {

// Bytes are 10 a signature.
std::vector<ZoneWeight> zones_of(const std::vector<ZoneNeed>& needs) {
  std::vector<ZoneWeight> zones;
  for (const ZoneNeed& need : needs) zones.push_back({need, need.signatures * ByteCount{10}});
  return zones;
}

RequestSteps one_by_one(const std::vector<ZoneId>& order) {
  RequestSteps requests;
  for (const ZoneId zone : order) requests.steps.push_back({zone});
  return requests;
}

TEST(EvictFarthest, IsBeladysRuleForZonesOfOneSize) {
  const auto zones = zones_of({{1, 1}, {1, 1}, {1, 1}});
  // Two fit. 0 1 load; 2 takes 1's place, which comes after 0; 0 stays; 1 takes 0's or 2's: 4
  // loads.
  const LoadTotals totals =
      evict_farthest(one_by_one({0, 1, 2, 0, 1}), {.zones = zones, .slots = 2});
  EXPECT_EQ(totals, (LoadTotals{.loads = 4, .signatures = 4, .bytes = 40}));
}

TEST(EvictFarthest, KeepsAllZonesOfAStep) {
  const auto zones = zones_of({{1, 1}, {1, 1}, {1, 1}});
  // 0 stays through both steps; 1 goes for 2 and comes back.
  RequestSteps requests;
  requests.steps = {{0, 1}, {0, 2}, {0, 1}};
  EXPECT_EQ(evict_farthest(requests, {.zones = zones, .slots = 2}),
            (LoadTotals{.loads = 4, .signatures = 4, .bytes = 40}));
}

TEST(EvictFarthest, HoldsTheLimitOfSignatures) {
  const auto zones = zones_of({{1, 50}, {1, 60}});
  // Slots for both, signatures for one: each comes twice.
  EXPECT_EQ(
      evict_farthest(one_by_one({0, 1, 0, 1}), {.zones = zones, .slots = 9, .signatures = 100}),
      (LoadTotals{.loads = 4, .signatures = 220, .bytes = 2200}));
  EXPECT_EQ(
      evict_farthest(one_by_one({0, 1, 0, 1}), {.zones = zones, .slots = 9, .signatures = 110}),
      (LoadTotals{.loads = 2, .signatures = 110, .bytes = 1100}));
}

TEST(LeastLoads, IsAllNeedsWhereNothingCanBeKept) {
  const auto zones = zones_of({{2, 5}, {2, 7}});
  EXPECT_EQ(least_loads(one_by_one({0, 1, 0, 1}), {.zones = zones, .slots = 2}),
            (LoadTotals{.loads = 4, .signatures = 24, .bytes = 240}));
  EXPECT_EQ(least_loads(one_by_one({0, 1, 0, 1}), {.zones = zones, .slots = 4}),
            (LoadTotals{.loads = 2, .signatures = 12, .bytes = 120}));
}

TEST(LeastLoads, TakesTheLargerBoundOfTwoLimits) {
  const auto zones = zones_of({{1, 50}, {1, 60}});
  EXPECT_EQ(
      least_loads(one_by_one({0, 1, 0, 1}), {.zones = zones, .slots = 9, .signatures = 100}).loads,
      4u);
  EXPECT_EQ(
      least_loads(one_by_one({0, 1, 0, 1}), {.zones = zones, .slots = 9, .signatures = 110}).loads,
      2u);
}

TEST(MostGain, TakesIntervalsInPartAndRoundsDown) {
  // One slot free, two intervals of size 2 over it: half of one fits, of gain 7: 3.5.
  const std::vector<std::uint64_t> free{1};
  const std::vector<Interval> both{{0, 0, 2, 7}, {0, 0, 2, 5}};
  EXPECT_EQ(most_gain(free, both), 3u);
}

TEST(MostGain, TakesWhatNeedsNoRoomWhole) {
  const std::vector<std::uint64_t> free{0, 0};
  // The second spans no step; the third has no size.
  const std::vector<Interval> all{{0, 1, 1, 4}, {1, 0, 9, 3}, {0, 1, 0, 2}};
  EXPECT_EQ(most_gain(free, all), 5u);
}

TEST(MostGain, FollowsRoomThatComesAndGoes) {
  // Room 2, 1, 2: the long interval takes the 1 in the middle or leaves it to the short ones.
  const std::vector<std::uint64_t> free{2, 1, 2};
  const std::vector<Interval> all{{0, 2, 1, 10}, {0, 1, 1, 6}, {1, 2, 1, 6}, {0, 0, 1, 3}};
  // Long (10) and the first step (3): 13.
  EXPECT_EQ(most_gain(free, all), 13u);
}

// The least cost of any schedule, by trying all: which zones are in memory after each step.
class BruteForce {
 public:
  BruteForce(const RequestSteps& requests, const BoundPlace& place)
      : requests_(requests), place_(place) {}

  template <typename CostOf>
  std::uint64_t least(CostOf&& cost_of) const {
    const std::size_t zones = place_.zones.size();
    std::map<unsigned, std::uint64_t> states{{0u, 0}};  // zones held, and the least cost
    for (const std::vector<ZoneId>& step : requests_.steps) {
      std::map<unsigned, std::uint64_t> next;
      unsigned needed = 0;
      for (const ZoneId zone : step) needed |= 1u << zone;
      for (const auto& [held, cost] : states) {
        for (unsigned after = 0; after < 1u << zones; ++after) {
          if ((after & needed) != needed || !fits(after)) continue;
          std::uint64_t sum = cost;
          for (ZoneId zone = 0; zone < zones; ++zone) {
            if ((after & ~held & (1u << zone)) != 0) sum += cost_of(place_.zones[zone]);
          }
          const auto [known, isnew] = next.emplace(after, sum);
          if (!isnew) known->second = std::min(known->second, sum);
        }
      }
      states = std::move(next);
    }
    std::uint64_t best = std::numeric_limits<std::uint64_t>::max();
    for (const auto& [held, cost] : states) best = std::min(best, cost);
    return best;
  }

 private:
  bool fits(unsigned held) const {
    NeedSum sum;
    for (ZoneId zone = 0; zone < place_.zones.size(); ++zone) {
      if ((held & (1u << zone)) != 0) sum.add(place_.zones[zone].need);
    }
    return sum.slots <= place_.slots &&
           (place_.signatures == 0 || sum.signatures <= place_.signatures);
  }

  const RequestSteps& requests_;
  const BoundPlace& place_;
};

class Random {
 public:
  explicit Random(std::uint32_t seed) : state_(seed) {}
  std::uint32_t below(std::uint32_t end) {
    state_ = state_ * 1664525u + 1013904223u;
    return (state_ >> 16) % end;
  }

 private:
  std::uint32_t state_;
};

// 300 small traces: steps of one or two zones of different sizes, with and without a limit of
// signatures.
TEST(LeastLoads, IsNeverOverTheBestOfAllSchedulesNorFarthestUnderIt) {
  Random random(11);
  std::uint64_t bounds = 0, optima = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<ZoneNeed> needs;
    for (int i = 0; i < 5; ++i) needs.push_back({1 + random.below(4), 1 + random.below(20)});
    const auto zones = zones_of(needs);
    RequestSteps requests;
    for (int i = 0; i < 14; ++i) {
      const ZoneId one = random.below(5), other = random.below(5);
      requests.steps.push_back({one});
      if (other != one && random.below(3) == 0) requests.steps.back().push_back(other);
    }
    const BoundPlace place{zones, 8 + random.below(3), random.below(2) * (40 + random.below(20))};
    const LoadTotals bound = least_loads(requests, place);
    const LoadTotals farthest = evict_farthest(requests, place);
    const BruteForce all(requests, place);
    const LoadTotals best{
        all.least([](const ZoneWeight&) { return std::uint64_t{1}; }),
        all.least([](const ZoneWeight& zone) { return std::uint64_t{zone.need.signatures}; }),
        all.least([](const ZoneWeight& zone) { return zone.stored_bytes; })};
    ASSERT_LE(bound.loads, best.loads) << "round " << round;
    ASSERT_LE(bound.signatures, best.signatures) << "round " << round;
    ASSERT_LE(bound.bytes, best.bytes) << "round " << round;
    ASSERT_LE(best.loads, farthest.loads) << "round " << round;
    ASSERT_LE(best.signatures, farthest.signatures) << "round " << round;
    bounds += bound.signatures;
    optima += best.signatures;
  }
  // A bound of 0 would pass the above: this one is within a tenth of the optimum.
  EXPECT_GT(bounds * 10, optima * 9);
}

// With one size, the relaxation has whole solutions, and so the bound is met.
TEST(LeastLoads, IsWhatFarthestLoadsForZonesOfOneSize) {
  Random random(5);
  const auto zones = zones_of({{1, 3}, {1, 3}, {1, 3}, {1, 3}, {1, 3}, {1, 3}});
  for (int round = 0; round < 200; ++round) {
    std::vector<ZoneId> order;
    for (int i = 0; i < 40; ++i) order.push_back(random.below(6));
    const BoundPlace place{zones, 2 + random.below(3), 0};
    const RequestSteps requests = one_by_one(order);
    EXPECT_EQ(least_loads(requests, place), evict_farthest(requests, place)) << "round " << round;
  }
}

}  // namespace
}  // namespace zonepack
