// SPDX-License-Identifier: Apache-2.0
// What zonectl shows of a status: JSON, Prometheus text, and the view of `watch`.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <nlohmann/json.hpp>
#include <numeric>
#include <regex>
#include <set>
#include <sstream>

#include "runtime/ctl/commands/figures.hpp"
#include "runtime/ctl/commands/watch_view.hpp"
#include "runtime/serve/answers.hpp"
#include "tests/unit/runtime/serve/fake_run.hpp"

namespace zonepack {
namespace {

using testing_support::FakeRun;

class CtlText : public testing::Test {
 protected:
  FakeRun run;
  LiveStatus live;
  ServerCounters counters;
  MessageBuilder message;

  CtlText() {
    live.state.pose.valid = live.state.pose.trusted = true;
    live.state.pose.T_map_base = {1.5, -2, 1};
    live.state.pose.covariance.xx = 0.04;
    live.state.zone = 1;
    live.state.zone_resident = true;
    live.budget = 8 * kMiB;
    live.charged = 2 * kMiB;
    live.cycle = {
        .count = 1000, .p50 = 3'000, .p99 = 9'000, .p999 = 20'000, .p9999 = 40'000, .max = 120'000};
    live.realtime = live.memory_locked = true;
    counters.not_keeping_up = 3;
  }

  const wire::Status& status() {
    const ServedMap map{.catalog = run.catalog,
                        .graph = run.graph,
                        .serial = 1,
                        .epoch = 0,
                        .zones = ZoneTable(3),
                        .nodes = std::nullopt};
    message.builder().Clear();
    const Message bytes = answer_status(message, 1, map, live, counters);
    return *flatbuffers::GetRoot<wire::Reply>(bytes.data())->body_as_Status();
  }

  static std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }
};

TEST_F(CtlText, ReportsABusThatIsDownAndCountsItsErrors) {
  EXPECT_EQ(complaints(status()), std::vector<std::string>{});
  live.bus = {.link = CanLink::kUp,
              .state = CanBusState::kOff,
              .error_frames = 7,
              .bus_offs = 2,
              .restarts = 1,
              .reconnects = 3};
  const auto json = nlohmann::json::parse(status_json(status()));
  EXPECT_EQ(json["can_up"], false);
  EXPECT_EQ(json["can_error_frames"], 7);
  EXPECT_EQ(json["bus_offs"], 2);
  EXPECT_EQ(json["bus_restarts"], 1);
  EXPECT_EQ(json["can_reopened"], 3);
  ASSERT_EQ(complaints(status()).size(), 1u);
  EXPECT_EQ(complaints(status())[0].substr(0, 10), "NO CAN BUS");
  live.bus.state = CanBusState::kActive;
  live.bus.link = CanLink::kAbsent;
  EXPECT_EQ(complaints(status()).size(), 1u);
}

// The rules that `promtool check metrics` applies.
TEST_F(CtlText, MetricsAreAsPrometheusWantsThem) {
  const std::regex name("zoned_[a-z0-9_]+");
  const std::regex sample("([a-z0-9_]+)(\\{[a-z]+=\"[^\"]*\"\\})? (-?[0-9.e+-]+)");
  const std::regex other_unit("_(ms|us|ns|kib|mib|percent|degrees|minutes)(_|$)");
  std::string current, type;
  std::set<std::string> seen;
  for (const std::string& line : lines_of(metrics_text(status()))) {
    std::smatch match;
    if (line.starts_with("# HELP ")) {
      current = line.substr(7, line.find(' ', 7) - 7);
      EXPECT_TRUE(std::regex_match(current, name)) << line;
      EXPECT_TRUE(seen.insert(current).second) << "told twice: " << line;
      EXPECT_GT(line.size(), 8 + current.size()) << "no help: " << line;
      type.clear();
    } else if (line.starts_with("# TYPE ")) {
      ASSERT_TRUE(type.empty()) << line;
      type = line.substr(8 + current.size());
      EXPECT_EQ(line, "# TYPE " + current + " " + type);
      EXPECT_EQ(type == "counter", current.ends_with("_total")) << line;
      EXPECT_TRUE(type == "counter" || type == "gauge") << line;
      EXPECT_FALSE(std::regex_search(current, other_unit)) << line;
    } else {
      ASSERT_TRUE(std::regex_match(line, match, sample)) << line;
      EXPECT_EQ(match[1], current);
    }
  }
  const std::string text = metrics_text(status());
  EXPECT_NE(text.find("\nzoned_not_keeping_up_total 3\n"), std::string::npos);
  EXPECT_NE(text.find("\nzoned_budget_bytes 8388608\n"), std::string::npos);
  EXPECT_NE(text.find("\nzoned_cycle_seconds{percentile=\"99\"} 9e-06\n"), std::string::npos);
  EXPECT_NE(text.find("\nzoned_zone_info{zone=\"b\"} 1\n"), std::string::npos);
}

TEST_F(CtlText, JsonHoldsTheSameNumbers) {
  const auto json = nlohmann::json::parse(status_json(status()));
  EXPECT_EQ(json["zone"], "b");
  EXPECT_EQ(json["budget_bytes"], 8 * kMiB);
  EXPECT_EQ(json["not_keeping_up"], 3);
  EXPECT_EQ(json["zone_resident"], true);
  EXPECT_EQ(json["pose"]["y_m"], -2);
  EXPECT_EQ(json["pose"]["sigma_m"], 0.2);
  EXPECT_EQ(json["cycle_us"]["p9999"], 40);
  live.state.pose.valid = false;
  EXPECT_TRUE(nlohmann::json::parse(status_json(status()))["pose"].is_null());
}

// Counters of the control thread, each set to a number of its own.
template <typename Counters>
Counters numbered(std::uint64_t first) {
  std::array<std::uint64_t, sizeof(Counters) / sizeof(std::uint64_t)> numbers;
  std::iota(numbers.begin(), numbers.end(), first);
  return std::bit_cast<Counters>(numbers);
}

TEST_F(CtlText, EveryCounterOfOverloadAndMemoryIsShown) {
  live.overload = numbered<OverloadCounters>(7'000'000);
  live.residency = numbered<ResidencyCounters>(8'000'000);
  const auto json = nlohmann::json::parse(status_json(status()));
  std::multiset<std::uint64_t> shown;
  for (const auto& value : json) {
    if (value.is_number_unsigned()) shown.insert(value.get<std::uint64_t>());
  }
  for (std::uint64_t i = 0; i < sizeof(OverloadCounters) / sizeof i; ++i) {
    EXPECT_EQ(shown.count(7'000'000 + i), 1u) << "counter " << i << " of OverloadCounters";
  }
  for (std::uint64_t i = 0; i < sizeof(ResidencyCounters) / sizeof i; ++i) {
    EXPECT_EQ(shown.count(8'000'000 + i), 1u) << "counter " << i << " of ResidencyCounters";
  }
}

TEST_F(CtlText, ARobotThatIsAheadOfItsMapIsSaidSoFirst) {
  EXPECT_TRUE(complaints(status()).empty());
  live.state.zone_resident = false;
  live.realtime = false;
  const auto lines = complaints(status());
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_TRUE(lines[0].starts_with("NOT KEEPING UP: the robot is in b")) << lines[0];
  EXPECT_NE(WatchView::line(status()).find("NOT KEEPING UP"), std::string::npos);
}

int columns_of(const std::string& line) {
  return static_cast<int>(std::ranges::count_if(
      line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

TEST_F(CtlText, TheViewFitsIntoAnyTerminal) {
  WatchView view;
  std::vector<WatchView::Zone> zones;
  for (int i = 0; i < 300; ++i) {
    WatchView::Zone zone;
    zone.name = "corridor-" + std::to_string(i);
    zone.pinned = zone.wanted = i % 3 == 0;
    zones.push_back(zone);
  }
  view.set_zones(zones);
  std::vector<TextPlan::Outline> outlines;  // 20 by 15 rooms of 5 m
  for (int i = 0; i < 300; ++i) {
    const double x = i % 20 * 5.0, y = i / 20 * 5.0;
    outlines.push_back({{x, y}, {x + 5, y}, {x + 5, y + 5}, {x, y + 5}});
  }
  view.set_plan({outlines, true});
  flatbuffers::FlatBufferBuilder builder;
  builder.Finish(wire::CreateEvent(builder, wire::EventKind::Evicted, 1, 5'000'000'000, 1,
                                   builder.CreateString("corridor-7")));
  for (int i = 0; i < 300; ++i) {
    view.add_event(*flatbuffers::GetRoot<wire::Event>(builder.GetBufferPointer()));
  }
  for (int i = 0; i < 700; ++i) view.add_status(status(), 0.2 * i);
  live.state.zone_resident = false;
  for (const int columns : {1, 10, 40, 80, 133, 300}) {
    for (const int rows : {1, 5, 24, 60}) {
      const auto lines = lines_of(view.picture(status(), {columns, rows}, false));
      EXPECT_LE(static_cast<int>(lines.size()), rows) << columns;
      for (const std::string& line : lines) EXPECT_LE(columns_of(line), columns) << line;
    }
  }
}

TEST_F(CtlText, TheViewFillsItsRowsWithThePlanAndTheLastEvents) {
  WatchView view;
  view.set_zones({{.name = "a"}, {.name = "b", .state = wire::ZoneState::Resident}, {.name = "c"}});
  // Three rooms in a row, 10 m by 20 m; the robot is at (1.5, -2), which is in a.
  view.set_plan({{{{0, -10}, {10, -10}, {10, 10}, {0, 10}},
                  {{10, -10}, {20, -10}, {20, 10}, {10, 10}},
                  {{20, -10}, {30, -10}, {30, 10}, {20, 10}}},
                 true});
  flatbuffers::FlatBufferBuilder builder;
  builder.Finish(wire::CreateEvent(builder, wire::EventKind::Evicted, 1, 5'000'000'000, 1,
                                   builder.CreateString("b")));
  for (int i = 0; i < 30; ++i) {
    view.add_event(*flatbuffers::GetRoot<wire::Event>(builder.GetBufferPointer()));
  }
  const auto count = [](const std::string& text, const std::string& word) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(word, at)) != text.npos; at += word.size()) ++found;
    return found;
  };
  for (const int columns : {40, 133}) {
    const std::string text = view.picture(status(), {columns, 30}, false);
    EXPECT_EQ(lines_of(text).size(), 30u) << text;
    EXPECT_GT(count(text, "▓"), 20u) << text;  // b, where the tracker has the robot
    EXPECT_EQ(count(text, "↗"), 1u) << text;   // 1 rad
    // Narrow: below the plan, five rows and what it does not need. Wide: in each row of the plan.
    EXPECT_GE(count(text, "evicted b"), columns == 40 ? 5u : 20u) << text;
  }
}

TEST_F(CtlText, TheViewShowsZonesBudgetTimelineAndNoEscapesWithoutColor) {
  WatchView view;
  view.set_zones(
      {{.name = "a",
        .state = wire::ZoneState::Filling,
        .wanted = true,
        .signatures = 10,
        .bytes = 1},
       {.name = "b",
        .state = wire::ZoneState::Resident,
        .wanted = true,
        .pinned = true,
        .leases = 1,
        .signatures = 10,
        .bytes = 1},
       {.name = "c\x1b[2J", .state = wire::ZoneState::Absent, .signatures = 10, .bytes = 1}});
  for (int i = 0; i <= 120; ++i) {
    live.state.zone = i < 60 ? 0 : 1;
    live.state.zone_resident = i >= 70;
    view.add_status(status(), i);
  }
  const std::string text = view.picture(status(), {69, 24}, false);
  EXPECT_NE(text.find("in b"), std::string::npos);
  EXPECT_NE(text.find("2.00 MiB of 8.00 MiB"), std::string::npos);
  EXPECT_NE(text.find("+a"), std::string::npos);
  EXPECT_NE(text.find("#b<PL"), std::string::npos);
  // 60 columns of 2 s, at 2 to 120 s: 29 in a, not in memory; b from 60 s, missing until 70 s.
  const std::string timeline = "a" + std::string(28, '!') + "b!!!!" + std::string(26, '-');
  EXPECT_NE(text.find(timeline), std::string::npos) << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos) << "a name is not obeyed";
  EXPECT_NE(view.picture(status(), {69, 24}, true).find("\x1b[32m"), std::string::npos);
}

}  // namespace
}  // namespace zonepack
