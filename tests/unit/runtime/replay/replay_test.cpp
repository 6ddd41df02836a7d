// SPDX-License-Identifier: Apache-2.0
// The recorded loop through the sample building, on zones of the sample map's sizes, without its
// packs.
#include "runtime/replay/replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "platform/can/can_log.hpp"
#include "tests/support/sample_catalog.hpp"

namespace zonepack {
namespace {

using testing::HasSubstr;

const std::string kData = ZONEPACK_TEST_DATA;
const std::string kRun = kData + "/scenario1_loop/";

class Replay : public testing::Test {
 protected:
  std::optional<ReplayResult> run(const std::function<void(ReplayInput&)>& change) {
    CanLogReader log(kRun + "can0.log");
    EXPECT_TRUE(log.open().ok());
    ReplayInput input{catalog, log};
    input.corrections = *read_corrections(kRun + "corrections.txt");
    input.truth = &truth;
    input.cycle = testing_support::sample_robot();
    input.load_packs = false;
    input.terms.budget = 64 * kMiB;
    change(input);
    auto result = replay(std::move(input));
    if (result) return std::move(*result);
    fault = result.error().message;
    return std::nullopt;
  }

  std::string fault;
  Catalog catalog = testing_support::sample_catalog(kData + "/zones.geojson");
  const TruthTrack truth = *read_truth(kRun + "base_groundtruth.txt");
};

TEST_F(Replay, LoadsEachZoneOfTheLoopOnceUnderAHundredSignatures) {
  const auto result = run([](ReplayInput& input) { input.terms.max_signatures = 100; });
  ASSERT_TRUE(result) << fault;
  const RunSummary& s = result->summary;
  EXPECT_EQ(s.signatures_loaded, 82u);  // L1 31 + H1 16 + C2 10 + H2 7 + C3 18
  EXPECT_EQ(s.signatures_unloaded, 0u);
  EXPECT_LE(s.peak_signatures, 100u);
  EXPECT_EQ(s.zone_absent_s, 0);
  EXPECT_EQ(s.wrong_zone_s, 0);
  EXPECT_EQ(s.budget_violations, 0u);
  EXPECT_EQ(s.zone_switches, 5u);
  EXPECT_LT(s.start_s, 0.5);
  EXPECT_LT(s.pose_error_m->max, 0.15);
}

TEST_F(Replay, UnloadsAsOldestFirstOverTheTrueZonesUnderFifty) {
  const auto result = run([](ReplayInput& input) { input.terms.max_signatures = 50; });
  ASSERT_TRUE(result) << fault;
  // L1 31, H1 47, C2 would be 57: L1 out, 26; H2 33; C3 would be 51: H1 out, 35; L1 would be 66: C2
  // and H2 out, 49. Loaded 82 + 31, unloaded 31 + 16 + 10 + 7.
  EXPECT_EQ(result->summary.signatures_loaded, 113u);
  EXPECT_EQ(result->summary.signatures_unloaded, 64u);
  EXPECT_EQ(result->summary.peak_signatures, 49u);
  EXPECT_EQ(result->summary.zone_absent_s, 0);
}

TEST_F(Replay, KeepsTheSmallestBudgetOnADenseMapAlsoFromSlowStorage) {
  catalog = testing_support::sample_catalog(kData + "/zones.geojson", 6);
  for (const std::uint64_t rate : {50'000'000u, 2'000'000u}) {
    const auto result = run([&](ReplayInput& input) {
      input.terms.budget.reset();
      input.terms.rates.storage = rate;
    });
    ASSERT_TRUE(result) << fault;
    EXPECT_EQ(result->summary.budget_bytes, catalog.smallest().bytes);
    EXPECT_LE(result->summary.peak_charged_bytes, catalog.smallest().bytes);
    EXPECT_EQ(result->summary.budget_violations, 0u);
    EXPECT_EQ(result->summary.zone_absent_s, 0) << rate;
    EXPECT_TRUE(result->warnings.empty());
  }
}

TEST_F(Replay, GivesTheSameEventsEveryTime) {
  const auto limit = [](ReplayInput& input) { input.terms.max_signatures = 50; };
  EXPECT_EQ(run(limit)->summary.event_log_hash, run(limit)->summary.event_log_hash);
  EXPECT_NE(run(limit)->summary.event_log_hash, run([](ReplayInput& input) {
                                                  input.terms.max_signatures = 60;
                                                })->summary.event_log_hash);
}

TEST_F(Replay, HoldsTheBudgetWithoutCorrectionsAfterTheStart) {
  catalog = testing_support::sample_catalog(kData + "/zones.geojson", 6);
  for (const bool at_truth : {false, true}) {
    const auto result = run([&](ReplayInput& input) {
      input.terms.budget.reset();
      input.corrections.resize(at_truth ? 0 : 2);
      if (at_truth) input.start.kind = StartChoice::Kind::kTruth;
    });
    ASSERT_TRUE(result) << fault;
    EXPECT_EQ(result->summary.budget_violations, 0u);
    EXPECT_LT(result->summary.pose_error_m->max, 3.0);  // dead reckoning over 89 m
  }
}

TEST_F(Replay, RecoversFromWrongFixesOnceGoodOnesReturn) {
  const auto result = run([](ReplayInput& input) {
    // Every second fix a few metres off, in ever other directions, for the first 80 s.
    for (std::size_t i = 1; i < 70; i += 2) {
      input.corrections[i].T_map_base.x_m += static_cast<double>(i % 7) - 3;
      input.corrections[i].T_map_base.y_m += 4 - static_cast<double>(i % 5);
    }
  });
  ASSERT_TRUE(result) << fault;
  EXPECT_EQ(result->summary.budget_violations, 0u);
  EXPECT_GT(result->summary.corrections_rejected, 25u);
  // Truth ends a moment before the bus.
  const auto& samples = result->trace.samples;
  const TraceSample& last = *std::find_if(samples.rbegin(), samples.rend(),
                                          [](const TraceSample& s) { return s.has_truth; });
  EXPECT_TRUE(last.pose_trusted);
  EXPECT_EQ(last.tracked_zone, last.true_zone);
  EXPECT_NEAR(last.estimate.x_m, last.truth.x_m, 0.15);
  EXPECT_NEAR(last.estimate.y_m, last.truth.y_m, 0.15);
}

TEST_F(Replay, NeverLoadsAnythingWithoutAnyPose) {
  const auto result = run([](ReplayInput& input) { input.corrections.clear(); });
  ASSERT_TRUE(result) << fault;
  EXPECT_EQ(result->summary.zones_loaded, 0u);
  EXPECT_EQ(result->summary.zone_absent_s, 0);
  EXPECT_NEAR(result->summary.start_s, 110.45, 0.1);  // all of it
  EXPECT_FALSE(result->summary.pose_error_m);
}

TEST_F(Replay, RefusesAZoneThatCannotFitByNameWithTheSmallestBudget) {
  EXPECT_FALSE(run([](ReplayInput& input) { input.terms.budget = 300 * kKiB; }));
  // L1: 31 * 28000 = 868000 bytes, 53 slots.
  EXPECT_THAT(fault, HasSubstr("zone L1 takes 873440 bytes"));
  EXPECT_THAT(fault, HasSubstr("smallest budget for this map is " +
                               std::to_string(catalog.smallest().bytes)));
  EXPECT_FALSE(run([](ReplayInput& input) { input.terms.budget = 1000; }));
  EXPECT_THAT(fault, HasSubstr("tables and read buffers alone take 100000 bytes"));
  EXPECT_FALSE(run([](ReplayInput& input) { input.terms.max_signatures = 30; }));
  EXPECT_THAT(fault, HasSubstr("zone L1 has 31 signatures, over the limit of 30"));
  EXPECT_THAT(fault, HasSubstr("smallest limit for this map is 49 signatures"));  // L1 + C3
}

TEST_F(Replay, WarnsWhenNeighboursDoNotFitTogetherAndStaysWithinTheLimit) {
  const auto result = run([](ReplayInput& input) { input.terms.max_signatures = 40; });
  ASSERT_TRUE(result) << fault;
  ASSERT_EQ(result->warnings.size(), 1u);
  EXPECT_THAT(result->warnings[0], HasSubstr("do not fit together in 40 signatures"));
  EXPECT_LE(result->summary.peak_signatures, 40u);
  EXPECT_EQ(result->summary.budget_violations, 0u);
  EXPECT_GT(result->summary.blocked_s, 0);  // before L1 and H1, 31 + 16
}

TEST_F(Replay, KeepsPinnedZonesAndRefusesUnknownOnes) {
  const auto result = run([](ReplayInput& input) {
    input.terms.max_signatures = 60;
    input.terms.pinned = {"R13"};
  });
  ASSERT_TRUE(result) << fault;
  EXPECT_EQ(result->summary.budget_violations, 0u);
  EXPECT_FALSE(run([](ReplayInput& input) { input.terms.pinned = {"attic"}; }));
  EXPECT_THAT(fault, HasSubstr("has no zone attic"));
  EXPECT_FALSE(run([](ReplayInput& input) {
    input.terms.max_signatures = 60;
    input.terms.pinned = {"H1"};  // 16 + 49 > 60
  }));
  EXPECT_THAT(fault, HasSubstr("zone H1 does not fit beside the largest pair"));
  const ZoneId r11[] = {catalog.find("R11")};
  EXPECT_FALSE(run([&](ReplayInput& input) {
    input.terms.budget = catalog.smallest().bytes;
    input.terms.pinned = {"R11"};
  }));
  EXPECT_THAT(fault, HasSubstr("the smallest budget for this map and its pins is " +
                               std::to_string(catalog.smallest(r11).bytes)));
  EXPECT_TRUE(run([](ReplayInput& input) { input.terms.pinned = {"R11"}; })) << fault;
}

TEST_F(Replay, TracksWithoutTruthToo) {
  const auto result = run([](ReplayInput& input) { input.truth = nullptr; });
  ASSERT_TRUE(result) << fault;
  EXPECT_EQ(result->summary.zone_absent_s, 0);
  EXPECT_FALSE(result->summary.pose_error_m);
}

TEST_F(Replay, RecordsTheRunForDrawing) {
  const auto result = run([](ReplayInput& input) { input.terms.max_signatures = 50; });
  ASSERT_TRUE(result) << fault;
  const RunTrace& trace = result->trace;
  EXPECT_EQ(trace.zones.size(), 24u);
  EXPECT_EQ(trace.portals.size(), 28u);
  EXPECT_NEAR(trace.duration_s, 110.44, 0.1);
  EXPECT_EQ(trace.samples.back().signatures_loaded, 113u);
  EXPECT_EQ(trace.events.front().event, "start");
  EXPECT_EQ(trace.events.back().event, "end");
  for (std::size_t i = 1; i < trace.samples.size(); ++i) {
    EXPECT_LE(trace.samples[i].t_s - trace.samples[i - 1].t_s, 0.12);
  }
}

}  // namespace
}  // namespace zonepack
