// SPDX-License-Identifier: Apache-2.0
#include "runtime/control/event.hpp"

#include "platform/base/require.hpp"

namespace zonepack {

const char* to_string(EventKind kind) noexcept {
  switch (kind) {
    case EventKind::kStart:
      return "start";
    case EventKind::kPoseInitialised:
      return "pose_initialised";
    case EventKind::kPoseTrusted:
      return "pose_trusted";
    case EventKind::kPoseReinitialised:
      return "pose_reinitialised";
    case EventKind::kCorrectionRejected:
      return "correction_rejected";
    case EventKind::kOdometryStale:
      return "odometry_stale";
    case EventKind::kOdometryResumed:
      return "odometry_resumed";
    case EventKind::kBusOff:
      return "bus_off";
    case EventKind::kBusRestarted:
      return "bus_restarted";
    case EventKind::kZoneEntered:
      return "zone_entered";
    case EventKind::kZoneWanted:
      return "zone_wanted";
    case EventKind::kZoneUnwanted:
      return "zone_unwanted";
    case EventKind::kLoadStarted:
      return "load_started";
    case EventKind::kLoadDone:
      return "load_done";
    case EventKind::kLoadCancelled:
      return "load_cancelled";
    case EventKind::kLoadGivenUp:
      return "load_given_up";
    case EventKind::kLoadFailed:
      return "load_failed";
    case EventKind::kEvicted:
      return "evicted";
    case EventKind::kBlocked:
      return "blocked";
    case EventKind::kUnblocked:
      return "unblocked";
    case EventKind::kNotKeepingUp:
      return "not_keeping_up";
    case EventKind::kMapOffered:
      return "map_offered";
    case EventKind::kMapChanged:
      return "map_changed";
    case EventKind::kMapRefused:
      return "map_refused";
    case EventKind::kDocked:
      return "docked";
    case EventKind::kUndocked:
      return "undocked";
    case EventKind::kHoldBegun:
      return "hold_begun";
    case EventKind::kHoldEnded:
      return "hold_ended";
    case EventKind::kZoneConfirmed:
      return "zone_confirmed";
    case EventKind::kMarkerIgnored:
      return "marker_ignored";
    case EventKind::kEnd:
      return "end";
    case EventKind::kPoseLost:
      return "pose_lost";
    case EventKind::kZoneSought:
      return "zone_sought";
    case EventKind::kTurnAsked:
      return "turn_asked";
    case EventKind::kPoseFound:
      return "pose_found";
    case EventKind::kZoneKept:
      return "zone_kept";
  }
  ZP_REQUIRE(false);
  return "";
}

}  // namespace zonepack
