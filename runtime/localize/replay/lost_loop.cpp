// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/replay/lost_loop.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/client/signature_view.hpp"
#include "runtime/localize/query/map_features.hpp"
#include "runtime/localize/replay/camera_loop.hpp"
#include "runtime/odometry/se2.hpp"

namespace zonepack::localize {
namespace {

// Fixes that were given and that the pose does not follow within this were not believed.
constexpr std::int64_t kBelieved_ns = 1'000'000'000;

}  // namespace

LostLoop::LostLoop(const Catalog& map, PlaceMatcher& matcher, ImageDescriber describe,
                   std::uint32_t descriptor_bytes, bool start_lost)
    : sweep_(search_zones(map), matcher),
      describe_(std::move(describe)),
      descriptor_bytes_(descriptor_bytes),
      start_lost_(start_lost) {}

void LostLoop::post(Command::Kind kind, ZoneId zone) {
  Command& command = waiting_.emplace_back();
  command.kind = kind;
  command.zone = zone;
}

void LostLoop::lose(const FixMoment& moment) {
  sweep_.begin(moment.now_ns, moment.state.zone);
  watch_.restart();
  post(Command::Kind::kLost);
  sought_ = kNoZone;
  given_ns_.reset();
  lost_since_ns_ = moment.now_ns;
  ++figures_.times_lost;
}

void LostLoop::follow(const FixMoment& moment) {
  wheels_.add(moment.now_ns, moment.state.T_wheels_base);
  if (std::exchange(start_lost_, false)) lose(moment);
  if (!sweep_.active()) return;
  const bool trusted = moment.state.pose.trusted && moment.now_ns > lost_since_ns_ &&
                       waiting_.empty() && !moment.state.lost;
  if (trusted) {
    figures_.lost_s += static_cast<double>(moment.now_ns - lost_since_ns_) * 1e-9;
    sweep_.end();
    given_ns_.reset();
  } else if (given_ns_ && moment.now_ns - *given_ns_ > kBelieved_ns) {
    given_ns_.reset();
  }
}

Outcome<void> LostLoop::see(const LoopImage& image) {
  auto features = describe_(image);
  if (!features) return features.error();
  sweep_.see({++images_, image.stamp_ns, *wheels_.at(image.stamp_ns), std::move(*features)});
  return {};
}

void LostLoop::judge(const QueryResult& result, const FixMoment& moment) {
  if (sweep_.active()) return;
  const bool own_zone = moment.state.zone_resident || moment.state.zone == kNoZone;
  if (watch_.add(result, moment.state.pose.trusted, own_zone)) lose(moment);
}

std::vector<FoundFix> LostLoop::search(const FixMoment& moment) {
  if (!searching() || moment.now_ns < busy_until_ns_) return {};
  const auto& resident = moment.resident.zones();
  const auto view_of = [&](ZoneId zone) {
    return std::find_if(resident.begin(), resident.end(),
                        [&](const ResidentZones::Zone& one) { return one.zone == zone; });
  };
  const ZoneId zone =
      sweep_.next(moment.now_ns, [&](ZoneId asked) { return view_of(asked) != resident.end(); });
  if (zone != kNoZone && view_of(zone) == resident.end()) {
    if (zone != std::exchange(sought_, zone)) post(Command::Kind::kSeek, zone);
  } else if (zone != kNoZone) {
    const std::vector<MapFeatures> features =
        copy_features(ZoneSignatures(view_of(zone)->view), zone, descriptor_bytes_);
    std::vector<const MapFeatures*> list;
    for (const MapFeatures& one : features) list.push_back(&one);
    const std::size_t pairs = sweep_.look(zone, list);
    busy_until_ns_ = moment.now_ns + static_cast<std::int64_t>(pairs) * kPair_ns;
    figures_.pairs += pairs;
    ++figures_.zones_looked_at;
  }
  if (sweep_.asks_for_turn(moment.now_ns)) {
    post(Command::Kind::kAskTurn);
    ++figures_.turns_asked;
  }
  auto fixes = sweep_.found(moment.now_ns);
  if (!fixes.empty()) given_ns_ = moment.now_ns;
  return fixes;
}

void LostLoop::command(const FixMoment& moment, std::vector<TimedCommand>& commands) {
  for (const Command& command : std::exchange(waiting_, {})) {
    commands.push_back({moment.now_ns + 1, command});
    commanded_.push_back(commands.back());
  }
}

}  // namespace zonepack::localize
