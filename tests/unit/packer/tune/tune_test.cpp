// SPDX-License-Identifier: Apache-2.0
#include "packer/tune/tune.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/packer/tune/ground_plan.hpp"

namespace zonepack::packer::tune {
namespace {

// From B into C as far as x and back, so many times.
Track rounds(const GroundPlan& plan, const std::string& name, double x_m, int times) {
  std::vector<double> stops{-15};
  for (int i = 0; i < times; ++i) stops.insert(stops.end(), {x_m, -15.0});
  return plan.drive(name, stops);
}

// Through B, A and all of C, then carried back to B, so many times: 60 slots in turn, of which 55
// hold none until it comes again.
Track circles(const GroundPlan& plan, const std::string& name, int times) {
  DrivenPath drive{name, false, {}, 0};
  for (int i = 0; i < times; ++i) {
    for (int x = -15; x < 40; ++x) {
      drive.poses.push_back({static_cast<double>(drive.poses.size()), {x + 0.5, 1}, 0});
    }
  }
  Track track = track_of(drive, name);
  locate(track, plan.zones());
  return track;
}

Tuned tuned(
    const GroundPlan& plan, std::vector<Track> tracks, bool halves, ByteCount budget,
    ByteCount load_bytes, const Fault& fault = [](const Layout&) { return ""; }) {
  std::ostringstream quiet;
  Progress progress(quiet, false);
  const Weigh weigh = [](const TunedZone& zone) { return GroundPlan::cost(zone.members.size()); };
  return tune(plan.layout, std::move(tracks), halves, plan.signatures,
              {.budget = budget, .load_bytes = load_bytes, .most_changes = 20, .cuts = 24}, weigh,
              fault, progress);
}

// Whether one of these cuts the zone.
bool changes(const std::vector<Step>& steps, const std::string& zone) {
  return std::ranges::any_of(
      steps, [&](const Step& step) { return step.names.from == std::vector<std::string>{zone}; });
}

// Room for 55 slots: A and C, but not B as well.
ByteCount room_of_55(const GroundPlan& plan) { return charged_with(plan.layout.fixed_bytes(), 55); }

TEST(Tune, CutsOffWhatNoDriveUses) {
  const GroundPlan plan = three_rooms();
  std::vector<Track> tracks{rounds(plan, "1", 5, 4), rounds(plan, "2", 5, 4)};
  const Tuned result = tuned(plan, tracks, false, room_of_55(plan), 1000);
  // B, A, C and then B, C three times and B: each round loads C and B anew.
  EXPECT_EQ(result.before.drives[0].loads, 10u);
  EXPECT_EQ(result.before.drives[0].signatures, 10u + 10 + 4 * 40 + 4 * 10);
  ASSERT_GE(result.made.size(), 1u);
  EXPECT_EQ(result.made[0].names.from, (std::vector<std::string>{"C"}));
  EXPECT_EQ(result.made[0].judgement.helped, 2u);
  EXPECT_EQ(result.made[0].judgement.hurt, 0u);
  // B, A and the part of C in use fit together, at a load each unless some are joined as well.
  EXPECT_LE(result.after.drives[0].loads, 3u);
  EXPECT_LT(result.after.drives[0].signatures, 30u);
  EXPECT_LT(result.after.smallest.bytes, result.before.smallest.bytes);
}

TEST(Tune, LeavesOutWhatHelpsOnlyInTraining) {
  const GroundPlan plan = three_rooms();
  // The first turns back early and gains from any cut behind that, more than the others lose; but
  // these load all of C each time, and a cut makes two loads of one. So held out, one drive wins
  // and two lose.
  std::vector<Track> tracks{rounds(plan, "early", 5, 20), circles(plan, "late", 4),
                            circles(plan, "later", 5)};
  const Tuned result = tuned(plan, tracks, false, room_of_55(plan), 50'000);
  EXPECT_FALSE(changes(result.made, "C"));
  ASSERT_FALSE(result.rejected.empty());
  const Step& step = result.rejected[0];
  EXPECT_EQ(step.names.from, (std::vector<std::string>{"C"}));
  EXPECT_EQ(step.judgement.helped, 1u);
  EXPECT_EQ(step.judgement.hurt, 2u);
  EXPECT_GT(step.judgement.training.stored, 0);
  EXPECT_EQ(step.reason, "helps only drives that it was chosen on");
}

TEST(Tune, JudgesTheFirstHalfOfOneDriveByItsSecond) {
  const GroundPlan plan = three_rooms();
  std::vector<Track> halves{rounds(plan, "first", 5, 6), circles(plan, "second", 6)};
  const Tuned result = tuned(plan, halves, true, room_of_55(plan), 50'000);
  EXPECT_FALSE(changes(result.made, "C"));
  ASSERT_TRUE(changes(result.rejected, "C"));
  const Step& step = *std::ranges::find(result.rejected, std::vector<std::string>{"C"},
                                        [](const Step& s) { return s.names.from; });
  EXPECT_EQ(step.reason, "helps only the half that it was chosen on");
  EXPECT_GT(step.judgement.training.stored, 0);
  // Six times through both parts: six loads more.
  EXPECT_EQ(step.judgement.held_out.loads, -6);

  std::vector<Track> alike{rounds(plan, "first", 5, 6), rounds(plan, "second", 6, 6)};
  EXPECT_TRUE(changes(tuned(plan, alike, true, room_of_55(plan), 1000).made, "C"));
}

TEST(Tune, JoinsZonesThatAreAlwaysEnteredTogether) {
  // Closets D and E of 2 m behind each other at the end; the pair that sets the budget is A and C.
  GroundPlan plan = three_rooms();
  plan.add("D", 40, 42);
  plan.add("E", 42, 44);
  plan.join(2, 3, 40);
  plan.join(3, 4, 42);
  const auto trips = [&](const std::string& name) {
    return plan.drive(name, {-15, 43, -15, 43, -15, 43, -15});
  };
  const Tuned result = tuned(plan, {trips("1"), trips("2")}, false, room_of_55(plan), 1'000'000);
  bool joined = false;
  for (const Step& step : result.made) {
    joined = joined || (step.kind == Change::Kind::kMerge && step.judgement.training.loads > 0);
    if (step.kind == Change::Kind::kMerge) {
      EXPECT_GE(step.smallest_saved, 0);
    }
  }
  EXPECT_TRUE(joined);
  EXPECT_LT(result.after.sum.loads, result.before.sum.loads);
}

TEST(Tune, CutsUntilTheBudgetSuffices) {
  const GroundPlan plan = three_rooms();
  // 35 slots: A and C have 50, so C must have parts of at most 25.
  const ByteCount budget = charged_with(plan.layout.fixed_bytes(), 35) + 4096;
  std::vector<Track> tracks{rounds(plan, "1", 39, 2), rounds(plan, "2", 39, 2)};
  const Tuned result = tuned(plan, tracks, false, budget, 1000);
  EXPECT_LE(result.after.smallest.bytes, budget);
  ASSERT_FALSE(result.made.empty());
  EXPECT_TRUE(result.made[0].for_budget);
  EXPECT_EQ(result.made[0].names.from, (std::vector<std::string>{"C"}));
}

TEST(Tune, LeavesOutWhatIsNoZoneFile) {
  const GroundPlan plan = three_rooms();
  std::vector<Track> tracks{rounds(plan, "1", 5, 4), rounds(plan, "2", 5, 4)};
  const Tuned result =
      tuned(plan, tracks, false, room_of_55(plan), 1000, [](const Layout&) { return "overlaps"; });
  EXPECT_TRUE(result.made.empty());
  ASSERT_FALSE(result.rejected.empty());
  EXPECT_EQ(result.rejected[0].reason, "overlaps");
}

}  // namespace
}  // namespace zonepack::packer::tune
