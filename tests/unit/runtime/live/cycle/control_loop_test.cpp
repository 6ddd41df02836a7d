// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/cycle/control_loop.hpp"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <vector>

#include "platform/process/clock.hpp"
#include "platform/sim/sim_can_bus.hpp"
#include "runtime/run/maps/modelled_loader.hpp"
#include "tests/support/rooms.hpp"
#include "tests/support/sample_catalog.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kPeriod_ns = 100'000;

// Cycles as fast as they come, on a time of their own; the run ends after some.
class CountedClock final : public RunClock {
 public:
  std::int64_t cycle_time_ns(std::uint64_t cycle, std::int64_t) noexcept override {
    now_ns = static_cast<std::int64_t>(cycle) * 10'000'000;
    bus.advance_to(now_ns);
    loader->advance_to(now_ns);
    if (cycle == late_cycle) sleep_until_ns(monotonic_ns() + 5 * kPeriod_ns);
    return now_ns;
  }
  bool await_inputs(std::uint64_t) noexcept override { return true; }
  bool more() noexcept override { return --left > 0; }
  std::int64_t offset_ns() noexcept override { return 7; }

  SimCanBus bus;
  ModelledLoader* loader = nullptr;
  std::int64_t now_ns = 0;
  std::uint64_t late_cycle = UINT64_MAX;
  int left = 20;
};

class Inputs final : public InputSink {
 public:
  void on_inputs(std::uint64_t cycle, const CycleInput& input,
                 std::int64_t offset) noexcept override {
    if (cycle >= frames.size()) return;
    frames[cycle] = input.frames.size();
    corrections[cycle] = input.corrections.size();
    commands[cycle] = input.commands.size();
    edges[cycle] = input.edges.size();
    for (const LineEdge& edge : input.edges) ages_ns.push_back(input.now_ns - edge.stamp_ns);
    offers[cycle] = input.offer;
    offset_ns = offset;
  }
  std::array<std::size_t, 64> frames{}, corrections{}, commands{}, edges{};
  std::vector<std::int64_t> ages_ns;
  std::uint64_t lost() const noexcept override { return 3; }

  std::array<MapOffer, 64> offers{};
  std::int64_t offset_ns = 0;
};

class Loop : public testing::Test {
 protected:
  Loop() { clock.loader = &loader; }

  void run(ControlSettings settings = {}) {
    settings.wall_period_ns = kPeriod_ns;
    settings.most_frames = 4;
    ControlLoop loop(settings, {.clock = clock,
                                .bus = clock.bus,
                                .maps = maps,
                                .loader = loader,
                                .notes = notes,
                                .overload = overload,
                                .logged_corrections = logged,
                                .poses = &poses,
                                .commands = &commands,
                                .replies = &replies,
                                .edges = &edges,
                                .tap = &inputs,
                                .status = status});
    before_run(loop);
    loop.run();
    cycles = loop.cycles();
    woken = loop.wakeup().count();
  }

  const ZoneGraph graph = testing_support::three_rooms();
  const std::vector<ZoneNeed> needs = std::vector<ZoneNeed>(3, ZoneNeed{4, 10});
  const std::vector<LoadWork> work = std::vector<LoadWork>(3, LoadWork{100, 0});
  const std::vector<float> load_s = std::vector<float>(3, 0.12f);
  Residency memory{3,
                   {.budget = 800,
                    .slot_bytes = 100,
                    .largest_pair = {.slots = 8, .signatures = 20},
                    .lease_ns = 1'000'000'000}};
  ModelledLoader loader{8, work, {1000, 1000}, nullptr};
  CountedClock clock;
  SpscQueue<LiveNote> queue{64};
  SpscQueue<Event> service{2};
  OverloadCounters overload;
  EventFanOut notes{queue, &service, overload};
  Cycle cycle{testing_support::sample_robot(),
              {.graph = graph,
               .needs = needs,
               .load_s = load_s,
               .pinned = {},
               .memory = memory,
               .loader = loader,
               .events = notes}};
  Catalog catalog;
  MapInUse in_use{
      .catalog = catalog, .graph = graph, .needs = needs, .memory = memory, .cycle = cycle};
  MapSwitcher maps{in_use, loader, nullptr};
  Residency other_memory{3,
                         {.budget = 800,
                          .slot_bytes = 100,
                          .largest_pair = {.slots = 8, .signatures = 20},
                          .lease_ns = 1'000'000'000}};
  Cycle other_cycle{testing_support::sample_robot(),
                    {.graph = graph,
                     .needs = needs,
                     .load_s = load_s,
                     .pinned = {},
                     .memory = other_memory,
                     .loader = loader,
                     .events = notes,
                     .map = 2}};
  MapInUse other_in_use{.catalog = catalog,
                        .graph = graph,
                        .needs = needs,
                        .memory = other_memory,
                        .cycle = other_cycle,
                        .number = 2};
  SpscQueue<PoseCorrection> logged{8}, poses{64};
  SpscQueue<Command> commands{64};
  SpscQueue<CommandReply> replies{8};
  SpscQueue<LineEdge> edges{32};
  Seqlock<LiveStatus> status;
  Inputs inputs;
  std::function<void(ControlLoop&)> before_run = [](ControlLoop&) {};
  std::uint64_t cycles = 0;
  std::uint64_t woken = 0;
};

TEST_F(Loop, RunsUntilTheClockSaysThatItIsOverAndTellsHowItStands) {
  run();
  EXPECT_EQ(cycles, 20u);
  const LiveStatus last = status.load();
  EXPECT_EQ(last.state.cycles, 20u);
  EXPECT_EQ(last.now_ns, 190'000'000);
  EXPECT_EQ(last.clock_offset_ns, 7);
  EXPECT_EQ(inputs.offset_ns, 7);
  EXPECT_EQ(last.budget, 800u);
}

TEST_F(Loop, LeavesFramesBeyondTheBoundOnTheBusAndCountsTheCycle) {
  CanFrame frame;
  frame.stamp_ns = 0;
  for (int i = 0; i < 10; ++i) clock.bus.push(frame);
  run();
  EXPECT_EQ(inputs.frames[0], 4u);
  EXPECT_EQ(inputs.frames[1], 4u);
  EXPECT_EQ(inputs.frames[2], 2u);
  EXPECT_EQ(overload.deferred_frames, 2u);
  EXPECT_EQ(status.load().can_frames, 10u);
}

TEST_F(Loop, TakesLoggedCorrectionsWhenTheyAreDueAndPosesOfOthersAtOnce) {
  PoseCorrection fix;
  fix.received_ns = 25'000'000;
  logged.push(fix);
  poses.push(fix);
  run();
  EXPECT_EQ(inputs.corrections[0], 1u);
  EXPECT_EQ(inputs.corrections[2], 0u);
  EXPECT_EQ(inputs.corrections[3], 1u);
}

TEST_F(Loop, TakesAtMostSixteenCommandsACycleAndAnswersEachOnceWhileThereIsRoom) {
  Command command;
  command.kind = Command::Kind::kLease;
  command.zone = 9;
  for (command.id = 1; command.id <= 20; ++command.id) commands.push(command);
  run();
  EXPECT_EQ(inputs.commands[0], 16u);
  EXPECT_EQ(inputs.commands[1], 4u);
  EXPECT_EQ(overload.deferred_commands, 1u);
  EXPECT_EQ(overload.lost_replies, 12u);
  CommandReply reply;
  for (std::uint64_t id = 1; replies.pop(reply); ++id) {
    EXPECT_EQ(reply.id, id);
    EXPECT_EQ(reply.error.code, ErrorCode::kNotFound);
  }
}

TEST_F(Loop, TellsWhoRecordsWhyAMapCannotBeUsedAndTakesWhatItCouldNotKeep) {
  before_run = [&](ControlLoop& loop) { loop.offer_refused(ErrorCode::kTruncated); };
  run();
  EXPECT_EQ(inputs.offers[0].fault, ErrorCode::kTruncated);
  EXPECT_EQ(inputs.offers[1].fault, ErrorCode::kOk);
  EXPECT_EQ(overload.lost_recordings, 3u);
}

TEST_F(Loop, TellsWhoRecordsOfAMapOnOfferAndChangesToIt) {
  before_run = [&](ControlLoop& loop) {
    ASSERT_TRUE(loop.offer(other_in_use));
    EXPECT_FALSE(loop.offer(other_in_use));
    loop.map_freed();
  };
  run();
  EXPECT_EQ(inputs.offers[0].map, 2u);
  EXPECT_EQ(inputs.commands[0], 1u);  // that the map is freed: nobody waits for a reply
  EXPECT_EQ(replies.size(), 0u);
  EXPECT_EQ(maps.map().number, 2u);  // no pose is known, so nothing had to be loaded
  EXPECT_EQ(status.load().state.map, 2u);
}

TEST_F(Loop, DropsCommandsOnZonesOfAnotherMap) {
  Command command;
  command.kind = Command::Kind::kPin;
  command.map = 2;
  commands.push(command);
  command.map = 1;
  commands.push(command);
  run();
  EXPECT_EQ(inputs.commands[0], 1u);
  CommandReply reply;
  ASSERT_TRUE(replies.pop(reply));
  EXPECT_EQ(reply.map, 1u);
  EXPECT_FALSE(replies.pop(reply));
}

TEST_F(Loop, TakesAtMostSixteenEdgesACycleAndKeepsTheirAge) {
  const std::int64_t before_ns = monotonic_ns();
  for (int i = 0; i < 17; ++i) edges.push({before_ns - 5'000'000, LineEdge::kHold, i % 2 == 0});
  edges.push({before_ns + 3'600'000'000'000, LineEdge::kHold, false});  // ahead: counts as now
  run();
  EXPECT_EQ(inputs.edges[0], 16u);
  EXPECT_EQ(inputs.edges[1], 2u);
  ASSERT_EQ(inputs.ages_ns.size(), 18u);
  EXPECT_GE(inputs.ages_ns[0], 5'000'000);
  EXPECT_EQ(inputs.ages_ns[17], 0);
  EXPECT_FALSE(status.load().frozen);  // by the last of them
}

TEST_F(Loop, LosesWhatAFullQueueCannotTakeAndCountsIt) {
  clock.left = 100;  // 100 records and an event for 64 places
  run();
  EXPECT_GT(overload.lost_records, 0u);
  EXPECT_EQ(cycles, 100u);
}

TEST_F(Loop, LeavesOutPeriodsThatHavePassedWhenARobotIsLate) {
  clock.late_cycle = 5;
  run();
  EXPECT_GE(overload.missed_deadlines, 1u);
  EXPECT_GE(overload.skipped_periods, 4u);
}

TEST_F(Loop, RunsEveryCycleOfALogHoweverLate) {
  clock.late_cycle = 5;
  ControlSettings settings;
  settings.may_skip = false;
  run(settings);
  EXPECT_EQ(cycles, 20u);
  EXPECT_GE(overload.missed_deadlines, 1u);
  EXPECT_EQ(overload.skipped_periods, 0u);
}

TEST_F(Loop, CountsAsWokenOnlyWhatSleptForItsDeadline) {
  clock.late_cycle = 5;  // 5 periods: the 4 cycles after it do not sleep, and the first never does
  ControlSettings settings;
  settings.may_skip = false;
  run(settings);
  EXPECT_LE(woken, 15u);
}

TEST_F(Loop, JudgesNoDeadlineWhenALogIsPlayedAtAnotherSpeed) {
  clock.late_cycle = 5;
  ControlSettings settings;
  settings.judge_deadlines = false;
  run(settings);
  EXPECT_EQ(overload.missed_deadlines, 0u);
}

}  // namespace
}  // namespace zonepack
