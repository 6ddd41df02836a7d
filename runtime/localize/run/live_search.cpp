// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/run/live_search.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "runtime/localize/query/map_features.hpp"
#include "runtime/odometry/se2.hpp"

namespace zonepack::localize {
namespace {

constexpr std::int64_t kFixesBelieved_ns = 1'000'000'000;  // else they were refused

}  // namespace

LiveSearch::LiveSearch(ZonedLink& link, std::vector<SearchZone> zones, Localizer& localizer,
                       const DetectorSettings& detector, FixCounters& counters, Say say)
    : link_(link),
      matcher_(localizer, detector),
      localizer_(localizer),
      descriptor_bytes_(detector.descriptor_bytes()),
      counters_(counters),
      say_(std::move(say)),
      sweep_(std::move(zones), matcher_) {}

void LiveSearch::follow(const RobotState& state) {
  if (state.wheels) wheels_.add(state.run_ns, *state.wheels);
}

Result<void> LiveSearch::begin(const RobotState& state) {
  if (sweep_.active() || !state.wheels) return {};
  if (const auto lost = link_.lose_pose(); !lost) return lost;
  say_("the robot is lost: " +
       std::string(state.has_pose ? "the images do not show what the map has there"
                                  : "zoned has no pose") +
       "; the map is searched zone by zone");
  sweep_.begin(state.run_ns, state.zone);
  watch_.restart();
  sought_ = kNoZone;
  given_ns_.reset();
  begun_ns_ = state.run_ns;
  counters_.count_lost();
  return {};
}

Result<void> LiveSearch::judge(const QueryResult& result, const RobotState& state) {
  if (sweep_.active() || !watch_.add(result, state.trusted, state.own_resident)) return {};
  return begin(state);
}

void LiveSearch::see(const GreyImage& image, std::int64_t run_ns) {
  const auto wheels = wheels_.at(run_ns);
  auto features = localizer_.detect(image);
  if (!wheels || !features) return;
  counters_.count_searching();
  sweep_.see({++images_, run_ns, *wheels, std::move(*features)});
}

bool LiveSearch::look(ZoneId zone) {
  std::vector<MapFeatures> features;
  ReadStatus status = ReadStatus::kOk;
  link_.hold(zone, [&] {
    status = link_.read(zone, [&](const ZoneSignatures& signatures) {
      features = copy_features(signatures, zone, descriptor_bytes_);
    });
  });
  if (status != ReadStatus::kOk) return false;
  std::vector<const MapFeatures*> list;
  for (const MapFeatures& one : features) list.push_back(&one);
  sweep_.look(zone, list);
  return true;
}

Result<std::vector<FoundFix>> LiveSearch::step(const RobotState& state) {
  std::vector<FoundFix> fixes;
  if (!sweep_.active()) return fixes;
  const auto report = [&] {
    counters_.set_search({sweep_.active(),
                          static_cast<std::uint32_t>(sweep_.search().views().size()),
                          static_cast<std::uint32_t>(sweep_.looked_at())});
  };
  if (!state.lost) {
    sweep_.end();
    report();
    char text[80];
    std::snprintf(text, sizeof text, "the robot is found, after %.1f s and %llu images",
                  static_cast<double>(state.run_ns - begun_ns_) / 1e9,
                  static_cast<unsigned long long>(std::exchange(images_, 0)));
    say_(text);
    return fixes;
  }
  if (given_ns_ && state.run_ns - *given_ns_ < kFixesBelieved_ns) return fixes;
  given_ns_.reset();
  const ZoneId zone =
      sweep_.next(state.run_ns, [&](ZoneId asked) { return link_.resident(asked); });
  if (zone != kNoZone && link_.resident(zone)) {
    look(zone);
  } else if (zone != kNoZone && zone != sought_) {
    if (const auto sought = link_.seek(zone); !sought) return sought.error();
    sought_ = zone;
  }
  for (; told_passed_over_ < sweep_.passed_over().size(); ++told_passed_over_) {
    say_("zone " + std::to_string(sweep_.passed_over()[told_passed_over_]) +
         " was not loaded in time to be searched: it does not fit next to what is held, or cannot "
         "be read; raise memory.budget, or look at zonectl events");
  }
  report();
  if (sweep_.asks_for_turn(state.run_ns)) {
    say_("no place fits yet: let the robot turn on the spot, or drive on");
    if (const auto asked = link_.ask_turn(); !asked) return asked.error();
  }
  fixes = sweep_.found(state.run_ns);
  if (!fixes.empty()) given_ns_ = state.run_ns;
  return fixes;
}

}  // namespace zonepack::localize
