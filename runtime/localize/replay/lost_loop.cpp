// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/replay/lost_loop.hpp"

#include <algorithm>
#include <utility>

#include "runtime/client/signature_view.hpp"
#include "runtime/localize/query/map_features.hpp"
#include "runtime/localize/replay/camera_loop.hpp"

namespace zonepack::localize {

Result<void> LostLoop::command(Command::Kind kind, ZoneId zone) {
  Command& command = waiting_.emplace_back();
  command.kind = kind;
  command.zone = zone;
  return {};
}

void LostLoop::lose(const FixMoment& moment) {
  static_cast<void>(driver_.begin(moment.now_ns, moment.state.zone));  // command() never fails
  ++times_lost_;
}

void LostLoop::follow(const FixMoment& moment) {
  now_ns_ = moment.now_ns;
  driver_.follow(moment.now_ns, moment.state.T_wheels_base);
  if (std::exchange(start_lost_, false)) lose(moment);
  if (!driver_.active()) return;
  const bool trusted = moment.state.pose.trusted && moment.now_ns > driver_.begun_ns() &&
                       waiting_.empty() && !moment.state.lost;
  if (!trusted) return;
  lost_s_ += lost_for_s(moment.now_ns);
  driver_.end();
}

Outcome<void> LostLoop::see(const LoopImage& image) {
  auto features = describe_(image);
  if (!features) return features.error();
  driver_.see(image.stamp_ns, std::move(*features));
  return {};
}

void LostLoop::judge(const QueryResult& result, const FixMoment& moment) {
  const bool own_zone = moment.state.zone_resident || moment.state.zone == kNoZone;
  if (driver_.notices(result, moment.state.pose.trusted, own_zone)) lose(moment);
}

const ResidentZones::Zone* LostLoop::find(ZoneId zone) const noexcept {
  const auto& zones = resident_->zones();
  const auto found = std::find_if(zones.begin(), zones.end(),
                                  [&](const ResidentZones::Zone& one) { return one.zone == zone; });
  return found == zones.end() ? nullptr : &*found;
}

std::optional<std::vector<MapFeatures>> LostLoop::read(ZoneId zone) {
  return copy_features(ZoneSignatures(find(zone)->view), zone, descriptor_bytes_);
}

std::vector<FoundFix> LostLoop::search(const FixMoment& moment) {
  if (moment.now_ns < busy_until_ns_) return {};
  resident_ = &moment.resident;
  const std::size_t before = driver_.figures().pairs;
  auto fixes = driver_.step(moment.now_ns);
  if (const std::size_t pairs = driver_.figures().pairs - before; pairs > 0) {
    busy_until_ns_ = moment.now_ns + static_cast<std::int64_t>(pairs) * kPair_ns;
  }
  return std::move(fixes).value();
}

void LostLoop::command(const FixMoment& moment, std::vector<TimedCommand>& commands) {
  for (const Command& command : std::exchange(waiting_, {})) {
    commands.push_back({moment.now_ns + 1, command});
    commanded_.push_back(commands.back());
  }
}

}  // namespace zonepack::localize
