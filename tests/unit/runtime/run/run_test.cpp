// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "runtime/run/maps/modelled_loader.hpp"
#include "tests/support/sample_catalog.hpp"

namespace zonepack {
namespace {

using testing::HasSubstr;

const std::string kZones = std::string(ZONEPACK_TEST_DATA) + "/zones.geojson";

// The sample building with the robot standing in zone L1; loads take no time.
class RunTest : public testing::Test, public RunObserver {
 protected:
  RunTest() : catalog(testing_support::sample_catalog(kZones)) {
    plan.cycle = testing_support::sample_robot();
    plan.terms.budget = 64 * kMiB;
    plan.terms.rates = {.storage = 1'000'000'000'000, .decode = 1'000'000'000'000};
  }

  std::shared_ptr<MapVersion> first() const {
    auto made = MapVersion::make(1, catalog, plan.terms);
    EXPECT_TRUE(made) << made.error().message;
    return std::move(*made);
  }

  void on_event(const Event& event, const MapVersion& map) noexcept override {
    seen.emplace_back(to_string(event.kind), map.number());
  }

  bool saw(const char* word, std::uint32_t map) const {
    return std::ranges::find(seen, std::pair(std::string(word), map)) != seen.end();
  }

  void stand(zonepack::Run& run, ModelledLoader& loader, int cycles) {
    for (int i = 0; i < cycles; ++i, now_ns += plan.terms.period_ns) {
      loader.advance_to(now_ns);
      std::vector<LoadResult> loads;
      while (const auto load = loader.poll()) loads.push_back(*load);
      run.step({.now_ns = now_ns, .loads = loads});
    }
  }

  Catalog catalog;
  RunPlan plan;
  std::int64_t now_ns = 1'000'000'000;
  std::vector<std::pair<std::string, std::uint32_t>> seen;
};

TEST_F(RunTest, AccountsForEachEventOnTheMapThatItIsAbout) {
  plan.keep_trace = true;
  zonepack::Run run(plan, first());
  ModelledLoader loader(catalog, run.accounted_map().model().slots, plan.terms.rates, nullptr);
  ASSERT_TRUE(run.open({.loader = loader}));
  run.add_observer(*this);
  const Point2 inside = catalog.zones[0].polygon.outer.front();
  run.start_at({now_ns, {inside.x_m, inside.y_m, 0}, {}, {}});
  stand(run, loader, 20);
  ASSERT_TRUE(saw("load_done", 1));
  EXPECT_EQ(run.accounted_map().number(), 1u);

  auto next = run.prepare(2, catalog);
  ASSERT_TRUE(next) << next.error().message;
  run.add(*next);
  ASSERT_TRUE(run.switcher().offer((*next)->in_use()));
  stand(run, loader, 20);
  EXPECT_TRUE(saw("map_offered", 1));
  EXPECT_TRUE(saw("map_changed", 2));
  EXPECT_EQ(run.accounted_map().number(), 2u);
  EXPECT_EQ(run.find(1), nullptr) << "the map before the change is let go";
  EXPECT_NE(run.find(2), nullptr);

  run.end();
  const auto summary = run.summarise(loader.bytes_loaded(), 0);
  EXPECT_TRUE(run.close_events().ok());
  EXPECT_EQ(summary.budget_violations, 0u);
  EXPECT_EQ(summary.cycles, 40u);
  EXPECT_EQ(summary.event_log_hash.size(), 64u);
  EXPECT_EQ(run.take_trace().zones.size(), catalog.zones.size());
}

TEST_F(RunTest, NamesAnEventLogThatCannotBeWritten) {
  plan.events = "/nowhere/events.jsonl";
  zonepack::Run run(plan, first());
  ModelledLoader loader(catalog, 1, plan.terms.rates, nullptr);
  const auto opened = run.open({.loader = loader});
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message, HasSubstr("/nowhere/events.jsonl: cannot be written: "));
}

TEST_F(RunTest, RefusesAMapThatItsBudgetCannotHold) {
  plan.terms.budget = 1000;
  const auto made = MapVersion::make(1, catalog, plan.terms);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kNoRoom);
  EXPECT_THAT(made.error().message, HasSubstr("smallest budget"));
}

TEST(FindStart, AsksForTruthThatCoversTheStart) {
  const TruthTrack truth(std::vector<TruthTrack::Sample>{{5'000'000'000, {1, 2, 0}}});
  const StartChoice at_truth{StartChoice::Kind::kTruth, {}};
  const auto near = find_start(at_truth, &truth, 4'500'000'000);
  ASSERT_TRUE(near);
  EXPECT_EQ((*near)->T_map_base, (Pose2{1, 2, 0}));
  const auto far = find_start(at_truth, &truth, 3'000'000'000);
  ASSERT_FALSE(far);
  EXPECT_THAT(far.error().message, HasSubstr("--start truth"));
  EXPECT_EQ(*find_start({}, &truth, 0), std::nullopt);
}

}  // namespace
}  // namespace zonepack
