// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/inputs/rejected_text.hpp"

#include <array>
#include <charconv>

namespace zonepack {
namespace {

void add_reason(std::string& text, std::uint64_t count, const std::string& reason) {
  if (count == 0) return;
  text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
}

std::string limit_text(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace

std::string rejected_text(const WheelOdometryCounters& counters,
                          const WheelOdometrySettings& settings) {
  std::string text;
  add_reason(text, counters.too_fast,
             "above max_speed " + limit_text(settings.max_speed_m_s) + " m/s or max_yaw_rate " +
                 limit_text(settings.max_yaw_rate_rad_s) + " rad/s");
  add_reason(text, counters.jumps - counters.too_fast,
             "above max_acceleration " + limit_text(settings.max_acceleration_m_s2) + " m/s2");
  add_reason(text, counters.not_newer, "not newer than the one before");
  add_reason(text, counters.unreadable, "too short, remote requests or not finite");
  add_reason(text, counters.unwatched, "while a CANopen node or SYNC was missing");
  return text;
}

std::string rejected_text(const PoseFilterCounters& counters) {
  std::string text;
  add_reason(text, counters.outliers, "outliers");
  add_reason(text, counters.too_old, "too old");
  add_reason(text, counters.from_future, "stamped after they came");
  add_reason(
      text, counters.invalid,
      "with a position, angle or sigma that cannot be (not finite, too large, sigma not over 0)");
  return text;
}

}  // namespace zonepack
