// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/messages/event_messages.hpp"

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include "platform/base/counted.hpp"
#include "platform/files/descriptor.hpp"
#include "platform/process/clock.hpp"
#include "runtime/live/messages/print_line.hpp"

namespace zonepack {
namespace {

constexpr int kStandardError = 2;

std::string remedy_of(std::string_view reason) {
  if (reason == "no room") {
    return "; zonepack plan says the budget with which maps change while the robot drives, and "
           "where the robot's zone is small there may be room";
  }
  if (reason == "frozen") return "; zonectl unfreeze, then reload again";
  return "; the robot goes on with it";
}

// What the word for a refused fix leaves open.
std::string meaning_of(std::string_view reason) {
  if (reason == to_string(CorrectionVerdict::kInvalid)) {
    return ": a position, angle or sigma that cannot be: not finite, beyond any map, an angle in "
           "degrees, or a sigma that is not over 0";
  }
  if (reason == to_string(CorrectionVerdict::kFromFuture)) {
    return ": stamped after it came; look at the clock of whatever gives it";
  }
  if (reason == to_string(CorrectionVerdict::kTooOld)) return ": from before pose.history";
  return {};
}

std::string stamp_in_seconds(std::int64_t ns) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f s", static_cast<double>(ns) / 1e9);
  return text;
}

std::string size_of(const Event& event) {
  return counted(event.signatures, "signature") + ", " + short_bytes(event.bytes);
}

std::string charged_of(const Event& event, const MapVersion& map) {
  const ResidencyLimits& limits = map.model().limits;
  std::string text =
      short_bytes(event.charged_bytes) + " of " + short_bytes(limits.budget) + " charged";
  if (limits.max_signatures > 0) {
    text += ", " + std::to_string(event.charged_signatures) + " of " +
            counted(limits.max_signatures, "signature");
  }
  return text;
}

std::string why_not_ready(const CycleState& state) {
  if (!state.pose.valid) return "there is no pose; give a fix, or zonectl pose X Y YAW_DEG";
  if (!state.pose.trusted) return "the pose is not trusted until two fixes agree";
  if (state.zone == kNoZone) return "the robot is in no zone of the map";
  return "the robot's own zone is not in memory";
}

}  // namespace

EventMessages::EventMessages(bool quiet)
    : EventMessages(quiet, {.ready = [] { return takes_a_line_now(kStandardError); },
                            .print = print_line,
                            .now_ns = monotonic_ns}) {}

EventMessages::EventMessages(bool quiet, Output output)
    : quiet_(quiet), output_(std::move(output)) {}

EventMessages::Message EventMessages::message_of(const Event& event, const MapVersion& map) {
  const Catalog& catalog = map.catalog();
  const std::string zone =
      event.zone < catalog.zones.size() ? catalog.zones[event.zone].name : std::string();
  const std::string reason = event.reason != nullptr ? event.reason : "";
  switch (event.kind) {
    case EventKind::kPoseInitialised:
      return {"the pose is known, and not trusted until two fixes agree"};
    case EventKind::kPoseTrusted:
      return {"the pose is trusted"};
    case EventKind::kPoseLost:
      return {"the robot is lost: the pose is given up, and the map searched zone by zone", true};
    case EventKind::kZoneSought:
      return {"zone " + zone + " is searched for the robot"};
    case EventKind::kTurnAsked:
      return {"the search needs other views: let the robot turn on the spot, or drive on", true};
    case EventKind::kPoseFound:
      return {"the robot is found"};
    case EventKind::kPoseReinitialised:
      return {
          "the pose was moved: refused fixes agreed with each other on another place; look at "
          "where the fixes come from",
          true};
    case EventKind::kCorrectionRejected:
      return {"fix refused: " + reason + meaning_of(reason)};
    case EventKind::kMarkerIgnored:
      return {"marker" + (zone.empty() ? "" : " of zone " + zone) + " refused: " + reason};
    case EventKind::kZoneEntered:
      return {zone.empty() ? "the robot is in no zone" : "zone " + zone + " entered"};
    case EventKind::kZoneConfirmed:
      return {"zone " + zone + " confirmed by a marker"};
    case EventKind::kLoadStarted:
      loads_[{event.map, event.zone}] = event.t_ns;
      return {};
    case EventKind::kLoadDone:
      return {loaded(event, zone) + "; " + charged_of(event, map)};
    case EventKind::kLoadGivenUp:
      loads_.erase({event.map, event.zone});
      return {"zone " + zone + " not loaded: no longer wanted"};
    case EventKind::kLoadFailed:
      loads_.erase({event.map, event.zone});
      return {"zone " + zone + " cannot be loaded: " + catalog.folder + "/" +
                  catalog.zones[event.zone].pack + ": " + reason +
                  "; it is tried again; build the map again or copy the pack again, zonepack "
                  "verify says more",
              true};
    case EventKind::kEvicted:
      return {"zone " + zone + " evicted: " + size_of(event) + "; " + charged_of(event, map)};
    case EventKind::kBlocked:
      return {"zone " + zone + " refused for now: it takes " + size_of(event) + ", with " +
                  charged_of(event, map) +
                  ", and not enough of that may be evicted; it waits; raise memory.budget "
                  "(zonepack plan says to what)",
              true};
    case EventKind::kUnblocked:
      return {"zone " + zone + " no longer waits for room"};
    case EventKind::kMapChanged:
      loads_.clear();
      return {"map changed: " + catalog.folder + " is in use, version " + to_hex(catalog.version),
              true};
    case EventKind::kZoneKept:
      return {"zone " + zone +
              " is the same in the new map and stays in memory: " + size_of(event)};
    case EventKind::kMapRefused:
      return {"map not changed: " + reason + "; version " + to_hex(catalog.version) +
                  " stays in use" + remedy_of(reason),
              true};
    case EventKind::kNotKeepingUp:
      return {"not keeping up: the robot entered zone " + zone +
                  " before it was loaded; drive slower, or raise the budget, preload.margin or the "
                  "storage's rate",
              true};
    case EventKind::kOdometryStale:
      odometry_missing_ = true;
      return {
          "odometry is missing: no frame of it for odometry.timeout; look at the bus and at "
          "can.interface",
          true};
    case EventKind::kOdometryResumed:
      return {"odometry is there", std::exchange(odometry_missing_, false)};
    case EventKind::kDocked:
      return {"docked: the pose is the dock's"};
    case EventKind::kUndocked:
      return {"undocked"};
    case EventKind::kHoldBegun:
      return {"the hold line is active: nothing is evicted"};
    case EventKind::kHoldEnded:
      return {"the hold line is released"};
    default:
      return {};
  }
}

std::string EventMessages::loaded(const Event& event, const std::string& zone) {
  std::string text = "zone " + zone + " loaded: " + size_of(event);
  if (const auto load = loads_.extract({event.map, event.zone})) {
    text += " in " + std::to_string((event.t_ns - load.mapped()) / 1'000'000) + " ms";
  }
  return text;
}

void EventMessages::on_event(const Event& event, const MapVersion& map) noexcept {
  t_ns_ = event.t_ns;
  say(message_of(event, map), event.t_ns);
  if (event.kind == EventKind::kEnd && left_out_ > 0 && output_.ready()) {
    output_.print(counted(left_out_, "line") + " left out: --events FILE writes every event");
    left_out_ = 0;
  }
}

void EventMessages::after_cycle(const CycleRecord& cycle, const MapVersion& map) noexcept {
  if (!started_ns_) started_ns_ = cycle.now_ns;
  const CycleState& state = cycle.state;
  odometry_came_ = odometry_came_ || !state.odometry_stale;
  if (!odometry_came_ && !odometry_missing_ && cycle.now_ns - *started_ns_ >= kOdometryWithin_ns) {
    odometry_missing_ = true;
    say({"no odometry since the start: the frames that came, if any, are not those that the "
         "settings read; zoned listen --config FILE --can SOURCE shows what comes and what is "
         "expected",
         true},
        kOdometryWithin_ns);
  }
  if (state.map_ready == map_ready_) return;
  map_ready_ = state.map_ready;
  const std::int64_t t_ns = cycle.now_ns - *started_ns_;
  if (!map_ready_) return say({"map not ready: " + why_not_ready(state), true}, t_ns);
  const bool known = state.zone < map.catalog().zones.size();
  say({"map ready" +
       (known ? ": the robot is in zone " + map.catalog().zones[state.zone].name : "")},
      t_ns);
}

void EventMessages::say(Message message, std::int64_t t_ns) {
  if (message.text.empty() || (quiet_ && !message.warning)) return;
  LineAllowance& allowance = message.warning ? warnings_ : news_;
  if (!allowance.take(output_.now_ns()) || !output_.ready()) {
    ++left_out_;
    return;
  }
  if (left_out_ > 0) {
    message.text += " (" + counted(left_out_, "line") + " left out before this one)";
    left_out_ = 0;
  }
  output_.print(message.warning ? message.text : stamp_in_seconds(t_ns) + ": " + message.text);
}

}  // namespace zonepack
