// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/messages/event_messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/sample_catalog.hpp"

namespace zonepack {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

// The sample building, with a budget of 4 MiB and at most 50 signatures.
class EventMessagesTest : public testing::Test {
 protected:
  EventMessagesTest() {
    MapTerms terms;
    terms.budget = 4 * kMiB;
    terms.max_signatures = 50;
    auto made = MapVersion::make(
        1, testing_support::sample_catalog(std::string(ZONEPACK_TEST_DATA) + "/zones.geojson"),
        terms);
    EXPECT_TRUE(made) << made.error().message;
    map = std::move(*made);
    h1 = map->catalog().find("H1");
  }

  EventMessages messages(bool quiet) {
    return EventMessages(quiet, {.ready = [this] { return ready; },
                                 .print = [this](const std::string& line) { said.push_back(line); },
                                 .now_ns = [this] { return now_ns; }});
  }

  Event event(EventKind kind, std::int64_t t_ns = 1'500'000'000) const {
    Event made;
    made.kind = kind;
    made.t_ns = t_ns;
    made.zone = h1;
    made.signatures = 16;
    made.bytes = 448 * kKiB;
    made.charged_bytes = 3 * kMiB;
    made.charged_signatures = 40;
    return made;
  }

  CycleRecord cycle(bool map_ready, std::int64_t now_ns_of_run) const {
    CycleRecord record;
    record.now_ns = now_ns_of_run;
    record.state.map_ready = map_ready;
    record.state.odometry_stale = false;
    record.state.zone = h1;
    record.state.pose.valid = true;
    record.state.pose.trusted = map_ready;
    return record;
  }

  std::shared_ptr<MapVersion> map;
  ZoneId h1 = kNoZone;
  bool ready = true;
  std::int64_t now_ns = 0;
  std::vector<std::string> said;
};

TEST_F(EventMessagesTest, SaysALineForWhatHappensToAZone) {
  EventMessages console = messages(false);
  console.on_event(event(EventKind::kZoneEntered), *map);
  console.on_event(event(EventKind::kLoadStarted, 1'500'000'000), *map);
  console.on_event(event(EventKind::kLoadDone, 1'534'000'000), *map);
  console.on_event(event(EventKind::kEvicted, 9'000'000'000), *map);
  // 1.534 - 1.5 s are 34 ms.
  EXPECT_THAT(said, ElementsAre("1.50 s: zone H1 entered",
                                "1.53 s: zone H1 loaded: 16 signatures, 448 KiB in 34 ms; 3.00 MiB "
                                "of 4.00 MiB charged, 40 of 50 signatures",
                                "9.00 s: zone H1 evicted: 16 signatures, 448 KiB; 3.00 MiB of 4.00 "
                                "MiB charged, 40 of 50 signatures"));
}

TEST_F(EventMessagesTest, SaysWhyAZoneOrAFixIsRefused) {
  EventMessages console = messages(false);
  console.on_event(event(EventKind::kBlocked), *map);
  Event fix = event(EventKind::kCorrectionRejected);
  fix.reason = "outlier";
  console.on_event(fix, *map);
  EXPECT_THAT(said, ElementsAre(HasSubstr("zone H1 refused for now: it takes 16 signatures, 448 "
                                          "KiB, with 3.00 MiB of 4.00 MiB charged"),
                                "1.50 s: fix refused: outlier"));
  EXPECT_THAT(said.front(), HasSubstr("raise memory.budget"));
}

TEST_F(EventMessagesTest, SaysWhatCannotBeInAFixThatIsRefused) {
  EventMessages console = messages(false);
  for (const CorrectionVerdict verdict :
       {CorrectionVerdict::kInvalid, CorrectionVerdict::kFromFuture, CorrectionVerdict::kTooOld}) {
    Event fix = event(EventKind::kCorrectionRejected);
    fix.reason = to_string(verdict);
    console.on_event(fix, *map);
  }
  EXPECT_THAT(
      said,
      ElementsAre(AllOf(HasSubstr("fix refused: invalid: "), HasSubstr("angle in degrees"),
                        HasSubstr("sigma that is not over 0")),
                  HasSubstr("fix refused: from_future: stamped after it came; look at the clock"),
                  HasSubstr("fix refused: too_old: from before pose.history")));
}

TEST_F(EventMessagesTest, SaysWhenTheMapIsReadyAndWhyNot) {
  EventMessages console = messages(false);
  console.after_cycle(cycle(false, 10'000'000'000), *map);
  console.after_cycle(cycle(true, 12'000'000'000), *map);
  console.after_cycle(cycle(true, 12'010'000'000), *map);
  console.after_cycle(cycle(false, 13'000'000'000), *map);
  EXPECT_THAT(said, ElementsAre("2.00 s: map ready: the robot is in zone H1",
                                "map not ready: the pose is not trusted until two fixes agree"));
}

TEST_F(EventMessagesTest, SaysOnceThatNoOdometryCame) {
  constexpr std::int64_t kWithin_ns = EventMessages::kOdometryWithin_ns;
  EventMessages console = messages(true);
  CycleRecord none = cycle(false, 10'000'000'000);
  none.state.odometry_stale = true;
  for (const std::int64_t after_ns : {std::int64_t{0}, kWithin_ns - 1}) {
    none.now_ns = 10'000'000'000 + after_ns;
    console.after_cycle(none, *map);
  }
  EXPECT_THAT(said, IsEmpty());
  for (const std::int64_t after_ns : {kWithin_ns, 2 * kWithin_ns}) {
    none.now_ns = 10'000'000'000 + after_ns;
    console.after_cycle(none, *map);
  }
  EXPECT_THAT(said, ElementsAre(StartsWith("no odometry since the start")));
  console.on_event(event(EventKind::kOdometryResumed), *map);
  EXPECT_EQ(said.back(), "odometry is there");
}

TEST_F(EventMessagesTest, KeepsOnlyWarningsWhenQuiet) {
  EventMessages console = messages(true);
  console.on_event(event(EventKind::kOdometryResumed), *map);  // at the start: nothing was missing
  console.on_event(event(EventKind::kZoneEntered), *map);
  console.on_event(event(EventKind::kLoadDone), *map);
  console.on_event(event(EventKind::kEvicted), *map);
  console.after_cycle(cycle(true, 1), *map);
  EXPECT_THAT(said, IsEmpty());
  console.on_event(event(EventKind::kNotKeepingUp), *map);
  console.on_event(event(EventKind::kOdometryStale), *map);
  console.on_event(event(EventKind::kOdometryResumed), *map);
  EXPECT_THAT(said, ElementsAre(StartsWith("not keeping up: the robot entered zone H1"),
                                StartsWith("odometry is missing"), "odometry is there"));
}

TEST_F(EventMessagesTest, LeavesOutAndCountsWhatComesTooFast) {
  EventMessages console = messages(false);
  const auto burst = static_cast<std::size_t>(LineAllowance::kBurst);
  for (std::size_t i = 0; i < burst + 3; ++i) console.on_event(event(EventKind::kEvicted), *map);
  EXPECT_EQ(said.size(), burst);
  // Warnings have an allowance of their own, and say what was left out.
  console.on_event(event(EventKind::kNotKeepingUp), *map);
  ASSERT_EQ(said.size(), burst + 1);
  EXPECT_THAT(said.back(), HasSubstr("(3 lines left out before this one)"));
  now_ns += 1'000'000'000 / LineAllowance::kPerSecond;  // room for one
  console.on_event(event(EventKind::kZoneEntered), *map);
  console.on_event(event(EventKind::kZoneEntered), *map);
  EXPECT_EQ(said.size(), burst + 2);
}

TEST_F(EventMessagesTest, WaitsForNoOutputThatIsStuck) {
  EventMessages console = messages(false);
  ready = false;
  console.on_event(event(EventKind::kZoneEntered), *map);
  EXPECT_THAT(said, IsEmpty());
  ready = true;
  console.on_event(event(EventKind::kEnd), *map);
  EXPECT_THAT(said, ElementsAre("1 line left out: --events FILE writes every event"));
}

}  // namespace
}  // namespace zonepack
