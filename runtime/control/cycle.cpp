// SPDX-License-Identifier: Apache-2.0
#include "runtime/control/cycle.hpp"

#include <algorithm>

#include "platform/base/require.hpp"
#include "platform/can/can_errors.hpp"
#include "runtime/odometry/se2.hpp"
#include "runtime/zones/zones_in_view.hpp"

namespace zonepack {
namespace {

// After a fix of a localizer that sees ahead: longer than it usually goes without one.
constexpr std::int64_t kViewHolds_ns = 30'000'000'000;
constexpr double kMostView_m = 20;
// To the nearest thousandth, by arithmetic that gives the same on every machine.
std::int32_t thousandths(double value) noexcept {
  constexpr double kMost = 2e9;
  const double scaled = std::clamp(value * 1000, -kMost, kMost);
  return static_cast<std::int32_t>(scaled < 0 ? scaled - 0.5 : scaled + 0.5);
}

}  // namespace

Cycle::Cycle(const CycleConfig& settings, const CycleParts& parts)
    : graph_(parts.graph),
      needs_(parts.needs),
      memory_(parts.memory),
      events_(parts.events, parts.map),
      odometry_(settings.odometry),
      filter_(settings.filter),
      tracker_(parts.graph, settings.tracker),
      preload_(parts.graph, parts.load_s, settings.preload),
      zone_keeper_(parts.memory, parts.loader, events_, parts.needs, parts.pinned, parts.directory,
                   settings.keeper),
      markers_(parts.graph, settings.markers),
      dock_(settings.dock),
      tracker_settings_(settings.tracker),
      outlook_(parts.graph, parts.load_s, parts.transitions, settings.preload,
               settings.preload.learn || parts.memory.has_order()) {
  state_.map = parts.map;
}

void Cycle::start_at(std::int64_t now_ns, const Pose2& T_map_base) noexcept {
  filter_.start_at(now_ns, T_map_base);
}

void Cycle::start_at(std::int64_t now_ns, const Pose2& T_map_base, double sigma_m,
                     double sigma_rad) noexcept {
  filter_.start_at(now_ns, T_map_base, sigma_m, sigma_rad);
}

void Cycle::continue_from(std::uint64_t cycle, std::int64_t start_ns) noexcept {
  state_.cycles = cycle;
  start_ns_ = start_ns;
}

void Cycle::continue_lost(ZoneId sought) noexcept {
  state_.lost = true;
  state_.sought = sought < needs_.size() ? sought : kNoZone;
}

const CycleState& Cycle::run(const CycleInput& input) noexcept {
  const std::int64_t now_ns = input.now_ns;
  if (state_.cycles == 0) start_ns_ = now_ns;
  events_.begin_cycle(state_.cycles, now_ns - start_ns_);
  if (state_.cycles == 0) emit(EventKind::kStart);
  ++state_.cycles;

  const bool had_pose = state_.pose.valid;
  std::uint32_t errors = 0;
  for (const CanFrame& frame : input.frames) {
    if (frame.error) errors |= frame.id;
    if (const auto increment = odometry_.take(frame)) {
      filter_.predict(*increment);
      state_.T_wheels_base = compose(state_.T_wheels_base, increment->motion.pose);
    }
  }
  if ((errors & kCanErrorBusOff) != 0) emit(EventKind::kBusOff);
  if ((errors & kCanErrorRestarted) != 0) emit(EventKind::kBusRestarted);
  watch_odometry(now_ns);
  for (const PoseCorrection& fix : input.corrections) take(fix, now_ns);
  state_.pose = filter_.estimate(now_ns);
  const ZoneId zone_before = tracker_.zone();
  for (const LineEdge& edge : input.edges) take(edge, now_ns);
  if (state_.pose.valid && !had_pose) emit(EventKind::kPoseInitialised);

  zone_keeper_.collect(now_ns, input.loads);
  ZP_REQUIRE(input.commands.size() <= kMostCommands);
  reply_count_ = 0;
  for (const Command& command : input.commands) {
    replies_[reply_count_] = obey(command, now_ns);
    replies_[reply_count_++].id = command.id;
  }
  follow_zones(zone_before, now_ns);
  if (memory_.has_order()) {
    memory_.begin_cycle(
        {now_ns, tracker_.zone(), outlook_.before(), outlook_.ahead(tracker_.zone())});
  }
  const Wanted wanted = list_wanted(now_ns);
  // The first is not the robot's own where that is of a layer that is not used.
  const bool own_first = tracker_.zone() == kNoZone || graph_.loadable(tracker_.zone());
  zone_keeper_.keep(now_ns, {{wanted.zones.data(), wanted.count},
                             wanted.urgent,
                             wanted.needed,
                             wanted.useful,
                             own_first && (!state_.lost || state_.pose.valid),
                             &outlook_.foresight(),
                             !outlook_.ahead(tracker_.zone()).empty(),
                             wanted.due});

  state_.zone_resident = state_.zone != kNoZone && memory_.resident(state_.zone);
  state_.map_ready = state_.pose.trusted && state_.zone_resident;
  state_.blocked = zone_keeper_.blocked();
  return state_;
}

void Cycle::take(const PoseCorrection& fix, std::int64_t now_ns) noexcept {
  const CorrectionVerdict verdict = filter_.correct(fix, now_ns);
  state_.pose = filter_.estimate(now_ns);
  if (is_used(verdict) && fix.view_m > 0) {
    view_m_ = std::min(fix.view_m, kMostView_m);
    view_until_ns_ = now_ns + kViewHolds_ns;
  }
  switch (verdict) {
    case CorrectionVerdict::kUsed:
      return;
    case CorrectionVerdict::kHypothesis:
      tracker_.restart();
      return;
    case CorrectionVerdict::kTrusted:
      tracker_.restart();
      emit(EventKind::kPoseTrusted);
      find_pose();
      return;
    case CorrectionVerdict::kReinitialised:
      tracker_.restart();
      preload_.restart();
      emit(EventKind::kPoseReinitialised);
      return;
    default:
      emit(EventKind::kCorrectionRejected, kNoZone, to_string(verdict));
  }
}

void Cycle::take(const LineEdge& edge, std::int64_t now_ns) noexcept {
  if (edge.line == LineEdge::kDock) {
    dock(edge, now_ns);
  } else if (edge.line == LineEdge::kHold) {
    freeze(frozen_, edge.active);
    emit(edge.active ? EventKind::kHoldBegun : EventKind::kHoldEnded);
  } else if (edge.active && edge.line - LineEdge::kFirstMarker < markers_.size()) {
    pass_marker(edge.line - LineEdge::kFirstMarker);
  }
}

void Cycle::dock(const LineEdge& edge, std::int64_t now_ns) noexcept {
  if (!edge.active || !dock_) {
    emit(EventKind::kUndocked);
    return;
  }
  const CorrectionVerdict verdict = filter_.reset(
      {edge.stamp_ns, now_ns, dock_->T_map_base, dock_->sigma_m, dock_->sigma_m, dock_->sigma_rad},
      now_ns);
  if (!is_used(verdict)) {
    emit(EventKind::kCorrectionRejected, kNoZone, to_string(verdict));
    return;
  }
  state_.pose = filter_.estimate(now_ns);
  tracker_.restart();
  preload_.restart();
  emit(EventKind::kDocked);
  find_pose();
}

void Cycle::pass_marker(std::size_t marker) noexcept {
  const MarkerVerdict verdict = markers_.pass(marker, state_.pose, tracker_.zone());
  if (verdict.refused != nullptr) {
    emit(EventKind::kMarkerIgnored, kNoZone, verdict.refused);
    return;
  }
  tracker_.confirm(verdict.zone, markers_.reach_m(marker));
  emit(EventKind::kZoneConfirmed, verdict.zone);
}

void Cycle::freeze(bool by_command, bool by_line) noexcept {
  frozen_ = by_command;
  held_ = by_line;
  memory_.freeze(frozen_ || held_);
}

void Cycle::lose_pose() noexcept {
  if (state_.lost) return;
  emit(EventKind::kPoseLost);  // with the pose that is given up
  state_.lost = true;
  filter_.forget();
  tracker_.forget();
  preload_.restart();
  state_.pose = filter_.estimate(state_.pose.t_ns);
}

void Cycle::find_pose() noexcept {
  if (!state_.lost) return;
  state_.lost = false;
  state_.sought = kNoZone;
  emit(EventKind::kPoseFound);
}

void Cycle::watch_odometry(std::int64_t now_ns) noexcept {
  const bool stale = odometry_.stale(now_ns);
  if (stale) filter_.drift_until(now_ns);
  if (stale == state_.odometry_stale) return;
  state_.odometry_stale = stale;
  emit(stale ? EventKind::kOdometryStale : EventKind::kOdometryResumed);
}

CommandReply Cycle::obey(const Command& command, std::int64_t now_ns) noexcept {
  CommandReply reply;
  const auto exists = [&](ZoneId zone) { return zone < needs_.size(); };
  const auto refuse = [&](Error error) { reply.error = error; };
  switch (command.kind) {
    case Command::Kind::kPin:
      if (!exists(command.zone) || !graph_.loadable(command.zone)) {
        refuse({ErrorCode::kNotFound});
      } else if (const auto pinned = zone_keeper_.pin(command.zone); !pinned) {
        refuse(pinned.error());
      }
      break;
    case Command::Kind::kUnpin:
      if (exists(command.zone)) {
        zone_keeper_.unpin(command.zone);
      } else {
        refuse({ErrorCode::kNotFound});
      }
      break;
    case Command::Kind::kFreeze:
    case Command::Kind::kUnfreeze:
      freeze(command.kind == Command::Kind::kFreeze, held_);
      break;
    case Command::Kind::kLease:
      if (!exists(command.zone)) {
        refuse({ErrorCode::kNotFound});
      } else if (const auto lease = memory_.lease(command.zone, now_ns); lease) {
        reply.lease = *lease;
      } else {
        refuse(lease.error());
      }
      break;
    case Command::Kind::kRelease:
      if (exists(command.lease.zone)) memory_.release(command.lease);
      break;
    case Command::Kind::kMapFreed:
      break;  // for MapSwitcher
    case Command::Kind::kLost:
      lose_pose();
      break;
    case Command::Kind::kSeek:
      if (command.zone != kNoZone && (!exists(command.zone) || !graph_.loadable(command.zone))) {
        refuse({ErrorCode::kNotFound});
      } else if (!state_.lost) {
        refuse({ErrorCode::kCancelled});
      } else {
        state_.sought = command.zone;
        if (command.zone != kNoZone) emit(EventKind::kZoneSought, command.zone);
      }
      break;
    case Command::Kind::kAskTurn:
      if (state_.lost) emit(EventKind::kTurnAsked);
      break;
    case Command::Kind::kRouteHint:
      outlook_.hint({command.route.data(), command.route_length}, tracker_.zone());
      break;
  }
  return reply;
}

void Cycle::follow_zones(ZoneId before, std::int64_t now_ns) noexcept {
  tracker_.update(state_.pose);
  if (tracker_.zone() != before) {
    state_.zone = tracker_.zone();
    emit(EventKind::kZoneEntered, state_.zone);
    outlook_.enter(state_.zone, now_ns);
    if (before != kNoZone && state_.zone != kNoZone) {
      ++state_.zone_switches;
      if (graph_.loadable(state_.zone) && !memory_.resident(state_.zone)) {
        emit(EventKind::kNotKeepingUp, state_.zone);
      }
    }
  }
  preload_.update(state_.pose, tracker_.pose_zone());
}

void Cycle::Wanted::add(ZoneId zone) noexcept {
  const auto end = zones.begin() + count;
  if (zone == kNoZone || count == zones.size() || std::find(zones.begin(), end, zone) != end)
    return;
  if (!graph->loadable(zone)) return;
  zones[count++] = zone;
}

Cycle::Wanted Cycle::list_wanted(std::int64_t now_ns) const noexcept {
  Wanted wanted;
  wanted.graph = &graph_;
  wanted.add(tracker_.zone());
  wanted.add(tracker_.pose_zone());
  if (!state_.pose.trusted) {
    for (const PoseHypothesis& place : filter_.hypotheses()) {
      wanted.add(graph_.zone_near(
          {place.T_map_base.x_m, place.T_map_base.y_m},
          tracker_settings_.start_radius_m + 3 * position_sigma_m(place.covariance)));
    }
  }
  for (const Approach& approach : preload_.approaches()) {
    if (approach.ahead) wanted.add(approach.zone);
  }
  wanted.urgent = wanted.count;
  wanted.add(state_.sought);
  for (const Approach& approach : preload_.approaches()) wanted.add(approach.zone);
  wanted.needed = wanted.count;
  want_view(wanted);
  wanted.useful = wanted.count;
  for (const Outlook::Likely& likely : outlook_.likely()) {
    if (now_ns >= likely.from_ns) wanted.add(likely.zone);
  }
  wanted.due = wanted.count;
  if (outlook_.ahead(tracker_.zone()).empty()) return wanted;
  for (const Outlook::Likely& likely : outlook_.likely()) wanted.add(likely.zone);
  return wanted;
}

// What a localizer can use in addition to the zones on the robot's own way: first what is there
// already, so that two zones that take turns behind a door post do not evict each other.
void Cycle::want_view(Wanted& wanted) const noexcept {
  if (view_m_ <= 0 || !state_.pose.valid || state_.pose.t_ns > view_until_ns_) return;
  const ZonesInView view(graph_, state_.pose.T_map_base, tracker_.pose_zone(), view_m_);
  for (const ZoneId zone : view.zones()) {
    if (memory_.state(zone) != ZoneState::kAbsent) wanted.add(zone);
  }
  for (const ZoneId zone : view.zones()) wanted.add(zone);
}

void Cycle::go_on_from(const Cycle& other) noexcept {
  const std::uint32_t map = state_.map;
  odometry_ = other.odometry_;
  filter_ = other.filter_;
  state_ = other.state_;
  state_.map = map;
  state_.zone = kNoZone;
  state_.zone_resident = false;
  state_.map_ready = false;
  state_.blocked = false;
  state_.sought = kNoZone;
  start_ns_ = other.start_ns_;
  view_m_ = other.view_m_;
  view_until_ns_ = other.view_until_ns_;
  outlook_.take_over(other.outlook_);
  freeze(other.frozen_, other.held_);
  events_.begin_cycle(state_.cycles - 1, other.events_.t_ns());
}

void Cycle::finish() noexcept { emit(EventKind::kEnd); }

void Cycle::emit(EventKind kind, ZoneId zone, const char* reason) noexcept {
  Event event;
  event.kind = kind;
  event.zone = zone;
  if (zone != kNoZone) {
    event.generation = memory_.generation(zone);
    event.signatures = needs_[zone].signatures;
    event.bytes = needs_[zone].slots * memory_.limits().slot_bytes;
  }
  event.charged_signatures = memory_.signatures();
  event.charged_bytes = memory_.charged();
  event.reason = reason;
  event.has_pose = state_.pose.valid;
  if (event.has_pose) {
    event.x_mm = thousandths(state_.pose.T_map_base.x_m);
    event.y_mm = thousandths(state_.pose.T_map_base.y_m);
    event.yaw_mrad = thousandths(state_.pose.T_map_base.yaw_rad);
  }
  events_.emit(event);
}

}  // namespace zonepack
