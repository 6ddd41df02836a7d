// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/run/live_search.hpp"

#include <cstdio>
#include <utility>

#include "runtime/localize/query/map_features.hpp"

namespace zonepack::localize {

LiveSearch::LiveSearch(ZonedLink& link, std::vector<SearchZone> zones, Localizer& localizer,
                       const DetectorSettings& detector, FixCounters& counters, Say say)
    : link_(link),
      matcher_(localizer, detector),
      localizer_(localizer),
      descriptor_bytes_(detector.descriptor_bytes()),
      counters_(counters),
      say_(std::move(say)),
      driver_(std::move(zones), matcher_, *this) {}

void LiveSearch::follow(const RobotState& state) {
  if (state.wheels) driver_.follow(state.run_ns, *state.wheels);
}

Result<void> LiveSearch::begin(const RobotState& state) {
  if (driver_.active() || !state.wheels) return {};
  if (const auto begun = driver_.begin(state.run_ns, state.zone); !begun) return begun;
  say_("the robot is lost: " +
       std::string(state.has_pose ? "the images do not show what the map has there"
                                  : "zoned has no pose") +
       "; the map is searched zone by zone");
  counters_.count_lost();
  return {};
}

Result<void> LiveSearch::judge(const QueryResult& result, const RobotState& state) {
  if (!driver_.notices(result, state.trusted, state.own_resident)) return {};
  return begin(state);
}

void LiveSearch::see(const GreyImage& image, std::int64_t run_ns) {
  auto features = localizer_.detect(image);
  if (!features || !driver_.see(run_ns, std::move(*features))) return;
  ++images_;
  counters_.count_searching();
}

std::optional<std::vector<MapFeatures>> LiveSearch::read(ZoneId zone) {
  std::vector<MapFeatures> features;
  ReadStatus status = ReadStatus::kOk;
  link_.hold(zone, [&] {
    status = link_.read(zone, [&](const ZoneSignatures& signatures) {
      features = copy_features(signatures, zone, descriptor_bytes_);
    });
  });
  if (status != ReadStatus::kOk) return std::nullopt;
  return features;
}

Result<void> LiveSearch::command(Command::Kind kind, ZoneId zone) {
  if (kind == Command::Kind::kLost) return link_.lose_pose();
  if (kind == Command::Kind::kSeek) return link_.seek(zone);
  say_("no place fits yet: let the robot turn on the spot, or drive on");
  return link_.ask_turn();
}

void LiveSearch::report() {
  const LostSweep& sweep = driver_.sweep();
  counters_.set_search({sweep.active(), static_cast<std::uint32_t>(sweep.search().views().size()),
                        static_cast<std::uint32_t>(sweep.looked_at())});
  for (; told_passed_over_ < sweep.passed_over().size(); ++told_passed_over_) {
    say_(passed_over_text(std::to_string(sweep.passed_over()[told_passed_over_]),
                          "raise memory.budget, or look at zonectl events"));
  }
}

Result<std::vector<FoundFix>> LiveSearch::step(const RobotState& state) {
  if (!driver_.active()) return std::vector<FoundFix>{};
  if (state.lost) {
    auto fixes = driver_.step(state.run_ns);
    report();
    return fixes;
  }
  driver_.end();
  report();
  char text[80];
  std::snprintf(text, sizeof text, "the robot is found, after %.1f s and %llu images",
                static_cast<double>(state.run_ns - driver_.begun_ns()) / 1e9,
                static_cast<unsigned long long>(std::exchange(images_, 0)));
  say_(text);
  return std::vector<FoundFix>{};
}

}  // namespace zonepack::localize
