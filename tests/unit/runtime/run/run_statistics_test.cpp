// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/run_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "tests/support/rooms.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kPeriod_ns = 100'000'000;

// Three rooms (rooms.hpp) and a robot that truly drives from (2, 2) to (6, 2) in 4 s.
class Statistics : public testing::Test {
 protected:
  void cycle(ZoneId tracked, bool blocked = false) {
    CycleState state;
    state.zone = tracked;
    state.blocked = blocked;
    const auto pose = truth.at(now_ns);
    state.pose.valid = pose.has_value();
    if (pose) state.pose.T_map_base = {pose->x_m, pose->y_m + 0.25, 0};
    statistics.after_cycle(record_of(now_ns, state, memory));
    now_ns += kPeriod_ns;
  }

  void hold(ZoneId zone, ZoneNeed need) {
    ASSERT_TRUE(memory.admit(zone, need, Purpose::kApproach, [](const Eviction&) {}).ok());
    memory.complete(zone, memory.generation(zone), {0, need.slots - 1, need.slots});
    for (const EventKind kind : {EventKind::kLoadStarted, EventKind::kLoadDone}) {
      Event event;
      event.kind = kind;
      event.zone = zone;
      statistics.on_event(event);
    }
  }

  RunSummary summary() const {
    RunSummary s;
    statistics.summarise(s);
    return s;
  }

  const ZoneGraph graph = testing_support::three_rooms();
  std::vector<ZoneNeed> needs = std::vector<ZoneNeed>(3, ZoneNeed{4, 10});
  const TruthTrack truth{{{0, {2, 2, 0}}, {4'000'000'000, {6, 2, 0}}}};
  const ResidencyLimits limits{1000, 200, 100, 25, {}, 0};
  Residency memory{3, limits};
  RunStatistics statistics{graph, needs, &truth, kPeriod_ns, limits};
  std::int64_t now_ns = 0;
};

TEST_F(Statistics, CountsTimeWithoutTheTrueZoneOnlyAfterTheFirstZoneIsThere) {
  cycle(0);
  cycle(0);
  hold(0, needs[0]);
  while (now_ns <= 2'000'000'000) cycle(0);  // the door is at 2 s: x = 4 belongs to a
  for (int i = 0; i < 5; ++i) cycle(1);      // in b, which is not resident
  EXPECT_DOUBLE_EQ(summary().start_s, 0.2);
  EXPECT_DOUBLE_EQ(summary().zone_absent_s, 0.5);
}

TEST_F(Statistics, WithoutTruthNothingIsKnownOfWrongZones) {
  RunStatistics blind(graph, needs, nullptr, kPeriod_ns, limits);
  CycleRecord record;
  record.state.zone = 0;
  blind.after_cycle(record);
  RunSummary s;
  blind.summarise(s);
  EXPECT_FALSE(s.wrong_zone_s);
  EXPECT_FALSE(s.localised);
  // A truth that ended before the run is none.
  now_ns = 5'000'000'000;
  cycle(0);
  EXPECT_FALSE(summary().wrong_zone_s);
}

TEST_F(Statistics, IsLocalisedOnceTheRobotsOwnZoneIsThere) {
  cycle(0);
  hold(1, needs[1]);
  cycle(0);
  EXPECT_FALSE(summary().localised);
  hold(0, needs[0]);
  cycle(0);
  EXPECT_TRUE(summary().localised);
}

TEST_F(Statistics, CallsTheTrackerWrongOnlyBeyondThirtyCentimetres) {
  // At 1 m/s: 0.1 m, 0.2 m, 0.3 m are within, 0.4 m and 0.5 m inside b are not.
  now_ns = 2'100'000'000;
  for (int i = 0; i < 5; ++i) cycle(0);
  ASSERT_TRUE(summary().wrong_zone_s);
  EXPECT_DOUBLE_EQ(*summary().wrong_zone_s, 0.2);
}

TEST_F(Statistics, FindsALimitExceededThoughTheSumsOfResidencyDoNotShowIt) {
  needs[2] = {5, 16};  // what it really takes
  hold(0, {4, 10});
  cycle(0);
  EXPECT_EQ(summary().budget_violations, 0u);
  hold(2, {4, 10});  // 200 + 9 * 100 > 1000 bytes, 26 > 25 signatures
  cycle(0);
  EXPECT_EQ(summary().budget_violations, 1u);
  EXPECT_EQ(summary().peak_charged_bytes, 1100u);
  EXPECT_EQ(summary().peak_signatures, 26u);
}

TEST_F(Statistics, CountsACycleWhoseSumsDifferFromTheEvents) {
  needs[1] = {3, 10};
  hold(1, {4, 10});
  cycle(0);
  EXPECT_EQ(summary().budget_violations, 1u);
}

TEST_F(Statistics, MeasuresThePoseAgainstTheTruth) {
  for (int i = 0; i < 10; ++i) cycle(0);
  ASSERT_TRUE(summary().pose_error_m);
  EXPECT_NEAR(summary().pose_error_m->p50, 0.25, 1e-6);
  EXPECT_NEAR(summary().pose_error_m->max, 0.25, 1e-6);
}

TEST_F(Statistics, CountsBlockedTime) {
  cycle(0, true);
  cycle(0, true);
  cycle(0, false);
  EXPECT_DOUBLE_EQ(summary().blocked_s, 0.2);
}

TEST_F(Statistics, KeepsNothingOfARobotsRunThatGrowsWithIt) {
  for (int i = 0; i < 5; ++i) cycle(0);
  hold(0, needs[0]);
  cycle(0);
  const RunTrace trace = statistics.take_trace();
  EXPECT_TRUE(trace.samples.empty());
  EXPECT_TRUE(trace.events.empty());
}

TEST_F(Statistics, KeepsEveryChangeAndTenSamplesASecondForDrawing) {
  statistics.keep_trace();
  for (int i = 0; i < 5; ++i) cycle(0);
  hold(0, needs[0]);
  cycle(0);
  const RunTrace trace = statistics.take_trace();
  ASSERT_EQ(trace.samples.size(), 6u);
  EXPECT_EQ(trace.samples[4].charged_bytes, 200u);
  EXPECT_EQ(trace.samples[5].charged_bytes, 600u);
  EXPECT_EQ(trace.samples[5].resident_signatures, 10u);
}

TEST_F(Statistics, KeepsWhichZonesWereHeldForDrawing) {
  statistics.keep_trace();
  cycle(0);
  hold(0, needs[0]);
  cycle(0);
  const RunTrace trace = statistics.take_trace();
  ASSERT_EQ(trace.holds.size(), 1u);
  EXPECT_EQ(trace.holds[0].zone, 0u);
  EXPECT_DOUBLE_EQ(trace.holds[0].to_s, trace.samples.back().t_s);  // held to the end
}

// A month at ten changes a second and more: what is kept stays within its bounds, from the first
// cycle to the last, and shows the trouble in between.
TEST_F(Statistics, ThinsWhatItKeepsOfALongRun) {
  statistics.keep_trace();
  const auto cycles = static_cast<int>(RunStatistics::kMostSamples * 4 + 17);
  for (int i = 0; i < cycles; ++i) {
    cycle(static_cast<ZoneId>(i % 2), i == cycles / 2);
    Event event;
    event.kind = EventKind::kZoneEntered;
    event.zone = 0;
    event.t_ns = now_ns;
    statistics.on_event(event);
  }
  const RunTrace trace = statistics.take_trace();
  EXPECT_LE(trace.samples.size(), RunStatistics::kMostSamples);
  EXPECT_GE(trace.samples.size(), RunStatistics::kMostSamples / 4);
  EXPECT_LE(trace.events.size(), RunStatistics::kMostTraceEvents);
  EXPECT_EQ(trace.samples.front().t_s, 0);
  EXPECT_NEAR(trace.samples.back().t_s, (cycles - 1) * 0.1, 5);
  EXPECT_EQ(std::ranges::count_if(trace.samples, &TraceSample::blocked), 1);
  EXPECT_TRUE(std::ranges::is_sorted(trace.samples, {}, &TraceSample::t_s));
}

}  // namespace
}  // namespace zonepack
