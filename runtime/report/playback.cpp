// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/playback.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "runtime/report/script_json.hpp"
#include "runtime/report/thinning.hpp"

namespace zonepack::report {
namespace {

constexpr double kPerSecond = 1000, kPerMetre = 1000, kPerRadian = 100;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<double, 3> kPoseTolerance = {0.01, 0.01, 0.02};  // m, m, rad

std::int64_t milliseconds(double t_s) noexcept {
  return std::isfinite(t_s) ? std::llround(std::clamp(t_s, 0.0, 9e12) * kPerSecond) : 0;
}

// Headings that go on over half a turn instead of jumping back, so that lines between them turn the
// short way.
std::vector<Waypoint> waypoints_of(const std::vector<PlayPose>& poses) {
  constexpr double kTurn = 2 * std::numbers::pi;
  std::vector<Waypoint> points;
  points.reserve(poses.size());
  double yaw = 0;
  for (const PlayPose& pose : poses) {
    Waypoint point{pose.t_s, {kUnknown, kUnknown, kUnknown}};
    if (pose.known && std::isfinite(pose.p_map.x_m + pose.p_map.y_m + pose.yaw_rad)) {
      yaw += std::remainder(pose.yaw_rad - yaw, kTurn);
      point.value = {pose.p_map.x_m, pose.p_map.y_m, yaw};
    }
    points.push_back(point);
  }
  return points;
}

std::string track_json(const std::vector<PlayPose>& poses) {
  const std::vector<Waypoint> points = waypoints_of(poses);
  std::vector<double> t, x, y, yaw;
  for (const std::size_t i : corners_of(points, kPoseTolerance, kMostPoses)) {
    t.push_back(points[i].t_s);
    x.push_back(points[i].value[0]);
    y.push_back(points[i].value[1]);
    yaw.push_back(points[i].value[2]);
  }
  return "{\"t\":" + script_differences(t, kPerSecond) +
         ",\"x\":" + script_differences(x, kPerMetre) +
         ",\"y\":" + script_differences(y, kPerMetre) +
         ",\"a\":" + script_differences(yaw, kPerRadian) + "}";
}

std::vector<PlayStay> longest(std::vector<PlayStay> stays) {
  if (stays.size() <= kMostStays) return stays;
  std::ranges::stable_sort(stays, std::greater(),
                           [](const PlayStay& s) { return s.to_s - s.from_s; });
  stays.resize(kMostStays);
  std::ranges::stable_sort(stays, {}, &PlayStay::from_s);
  return stays;
}

std::string events_json(const std::vector<PlayEvent>& events) {
  std::vector<std::string> kinds;
  std::vector<double> times;
  std::vector<std::int64_t> kind, zone;
  for (const PlayEvent& event : events) {
    auto found = std::ranges::find(kinds, event.kind);
    if (found == kinds.end()) found = kinds.insert(kinds.end(), event.kind);
    times.push_back(event.t_s);
    kind.push_back(found - kinds.begin());
    zone.push_back(event.zone == PlayEvent::kNoZone ? -1 : static_cast<std::int64_t>(event.zone));
  }
  return "{\"kinds\":" + script_strings(kinds) + ",\"t\":" + script_differences(times, kPerSecond) +
         ",\"k\":" + script_numbers(kind) + ",\"z\":" + script_numbers(zone) + "}";
}

}  // namespace

std::string playback_json(const Playback& playback) {
  std::vector<std::int64_t> holds, stays;
  for (const PlayHold& hold : playback.holds) {
    const std::int64_t from = milliseconds(hold.from_s);
    holds.insert(holds.end(), {static_cast<std::int64_t>(hold.zone), from,
                               milliseconds(hold.ready_s) - from, milliseconds(hold.to_s) - from});
  }
  for (const PlayStay& stay : longest(playback.stays)) {
    const std::int64_t from = milliseconds(stay.from_s);
    stays.insert(stays.end(),
                 {static_cast<std::int64_t>(stay.zone), from, milliseconds(stay.to_s) - from});
  }
  return "{\"duration\":" + std::to_string(milliseconds(playback.duration_s)) +
         ",\"track\":" + track_json(playback.poses) + ",\"holds\":" + script_numbers(holds) +
         ",\"stays\":" + script_numbers(stays) + ",\"events\":" + events_json(playback.events) +
         "}";
}

}  // namespace zonepack::report
