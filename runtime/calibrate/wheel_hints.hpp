// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "runtime/calibrate/drive_windows.hpp"
#include "runtime/calibrate/expected_motion.hpp"
#include "runtime/calibrate/signal_trace.hpp"
#include "runtime/settings/settings.hpp"

// What is probably wrong with the settings of a new robot's wheels, from what its signals did.
// Functions of their arguments only. Not for the control thread.
namespace zonepack {

// One mistake, and the settings that mend it.
struct WheelHint {
  // One word for programs: swapped, sign, same-signal, silent, unrelated, counter-as-speed,
  // speed-as-position, unit, gear, ticks, radius, scale, factor, track, too-fast.
  std::string kind;
  std::string text;               // what was seen and what it means, in one sentence
  std::vector<std::string> yaml;  // lines to paste, sections included
};

// What was seen of the wheels; anything may be missing.
struct WheelEvidence {
  std::vector<SignalTrace> traces;  // of signals_of(), in that order
  std::deque<DriveWindow> windows;  // of a model with two sides or of a twist
  std::string reference;            // where the truth of the windows is from, "the true path"
  std::optional<ExpectedMotion> expected;
  std::uint64_t samples = 0;   // complete ones
  std::uint64_t too_fast = 0;  // of these: refused as above max_speed or max_yaw_rate
  double usual_speed_m_s = 0;  // of the refused
};

// The most certain and most basic first; empty when nothing looks wrong.
std::vector<WheelHint> wheel_hints(const Settings& settings, const WheelEvidence& evidence);

// Whether the model has a left and a right wheel, and nothing else.
bool has_sides(OdometryModel model) noexcept;

// The settings without limits of speed, yaw rate and acceleration, to see what was refused.
WheelOdometrySettings without_limits(const WheelOdometrySettings& settings);

// "hint: TEXT" and the YAML below it, indented; ends with a line feed.
std::string hint_text(const WheelHint& hint);

// An array of {"kind", "text", "yaml"}.
std::string hints_json(const std::vector<WheelHint>& hints);

}  // namespace zonepack
