// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "runtime/control/cycle.hpp"
#include "runtime/run/maps/modelled_loader.hpp"
#include "tests/support/allocation_count/allocation_count.hpp"
#include "tests/support/rooms.hpp"
#include "tests/support/sample_catalog.hpp"

namespace zonepack {

inline constexpr std::int64_t kPeriod_ns = 10'000'000;

// Three rooms a, b, c in a row (rooms.hpp), 4 slots each, room for two; a load takes 0.1 s.
class CycleTest : public testing::Test, public EventSink {
 protected:
  CycleTest() { events.reserve(4096); }

  void on_event(const Event& event) noexcept override { events.push_back(event); }

  // One cycle, with a frame that says how far the wheels have come.
  void step(std::vector<PoseCorrection> fixes = {}, bool with_frame = true) {
    now_ns += kPeriod_ns;
    loader.advance_to(now_ns);
    CanFrame frame;
    frame.stamp_ns = now_ns;
    frame.id = 0x311;
    frame.len = 8;
    put(frame, 0, left_mm);
    put(frame, 4, right_mm);
    const testing_support::AllocationCount allocated;
    std::array<LoadResult, 4> loads;
    std::size_t load_count = 0;
    while (const auto load = loader.poll()) loads[load_count++] = *load;
    cycle.run({now_ns,
               {&frame, with_frame ? 1u : 0u},
               fixes,
               {loads.data(), load_count},
               std::exchange(commands, {}),
               {},
               std::exchange(edges, {})});
    allocations += allocated.count();
  }

  void drive(double metres, double metres_per_cycle = 0.01) {
    for (double done = 0; done < metres; done += metres_per_cycle) {
      left_mm += static_cast<std::int32_t>(metres_per_cycle * 1000);
      right_mm += static_cast<std::int32_t>(metres_per_cycle * 1000);
      step();
    }
  }

  void stand(int cycles) {
    for (int i = 0; i < cycles; ++i) step();
  }

  PoseCorrection fix(double x_m, double y_m, double yaw_rad = 0) const {
    return {.stamp_ns = now_ns,
            .received_ns = now_ns,
            .T_map_base = {x_m, y_m, yaw_rad},
            .sigma_x_m = 0.03,
            .sigma_y_m = 0.03,
            .sigma_yaw_rad = 0.01};
  }

  // The fixes of one second apart that make a pose trusted.
  void trust(double x_m, double y_m) {
    step();
    step({fix(x_m, y_m)});
    stand(20);
    step({fix(x_m, y_m)});
    stand(20);
    ASSERT_TRUE(cycle.state().pose.trusted);
  }

  std::vector<std::string> words() const {
    std::vector<std::string> all;
    for (const Event& event : events) {
      std::string word = to_string(event.kind);
      if (event.zone != kNoZone) word += " " + graph.name(event.zone);
      all.push_back(word);
    }
    return all;
  }

  static void put(CanFrame& frame, std::size_t at, std::int32_t value) {
    const auto bits = static_cast<std::uint32_t>(value);
    for (std::size_t i = 0; i < 4; ++i) {
      frame.data[at + i] = static_cast<std::uint8_t>(bits >> (24 - 8 * i));
    }
  }

  const ZoneGraph graph = testing_support::three_rooms();
  const std::vector<ZoneNeed> needs =
      std::vector<ZoneNeed>(3, ZoneNeed{.slots = 4, .signatures = 10});
  const std::vector<LoadWork> work = std::vector<LoadWork>(3, LoadWork{.stored_bytes = 100});
  const std::vector<float> load_s = std::vector<float>(3, 0.12f);
  Residency memory{3,
                   {.budget = 800,
                    .slot_bytes = 100,
                    .largest_pair = {.slots = 8, .signatures = 20},
                    .lease_ns = 1'000'000'000}};
  ModelledLoader loader{8, work, {.storage = 1000, .decode = 1000}, nullptr};
  static CycleConfig robot() {
    CycleConfig config = testing_support::sample_robot();
    config.dock = CycleConfig::Dock{.T_map_base = {10, 2, 0}, .sigma_m = 0.02, .sigma_rad = 0.02};
    config.markers = {{.name = "door", .zone = "a", .other = "b", .reach_m = 0.5}};
    return config;
  }
  Cycle cycle{robot(),
              {.graph = graph,
               .needs = needs,
               .load_s = load_s,
               .pinned = {},
               .memory = memory,
               .loader = loader,
               .events = *this}};
  Command command(Command::Kind kind, ZoneId zone = kNoZone) {
    Command made;
    made.kind = kind;
    made.id = ++last_id;
    made.zone = zone;
    return made;
  }

  // The reply to one command, taken by the next cycle.
  CommandReply ask(const Command& question) {
    commands = {question};
    step();
    return cycle.replies()[0];
  }

  // One cycle that takes a line's change from age_ns ago.
  void edge(std::uint32_t line, bool active, std::int64_t age_ns = 0) {
    edges = {{.stamp_ns = now_ns + kPeriod_ns - age_ns, .line = line, .active = active}};
    step();
  }

  std::vector<Command> commands;
  std::vector<LineEdge> edges;
  std::uint64_t last_id = 0;
  std::vector<Event> events;
  std::size_t allocations = 0;
  std::int64_t now_ns = 1'000'000'000;
  std::int32_t left_mm = 5000, right_mm = 5000;
};

}  // namespace zonepack
