// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/side_faults.hpp"

#include <algorithm>
#include <utility>

#include "platform/base/number_text.hpp"

namespace zonepack {
namespace {

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string invert_line(const std::vector<std::string>& keys) {
  std::string text = "  invert: [";
  for (const std::string& key : keys) text += (text.back() == '[' ? "" : ", ") + key;
  return text + "]";
}

// The lines of the section odometry that differ once the faults are mended.
std::vector<std::string> side_lines(const OdometrySettings& o, const SideFaults& faults) {
  std::vector<std::string> lines = {"odometry:"};
  bool left = contains(o.invert, "left") != faults.left_sign;
  bool right = contains(o.invert, "right") != faults.right_sign;
  if (faults.swapped) {
    lines.push_back("  left: " + o.right);
    lines.push_back("  right: " + o.left);
    std::swap(left, right);
    if (o.scale_left != o.scale_right) {
      lines.push_back("  scale_left: " + short_number(o.scale_right, 9));
      lines.push_back("  scale_right: " + short_number(o.scale_left, 9));
    }
  }
  if (left != contains(o.invert, "left") || right != contains(o.invert, "right")) {
    std::vector<std::string> keys;
    if (left) keys.emplace_back("left");
    if (right) keys.emplace_back("right");
    lines.push_back(invert_line(keys));
  }
  return lines;
}

}  // namespace

std::string named(const SignalKey& key) { return "odometry." + key.key + " (" + key.name + ")"; }

std::string inverted_too(const OdometrySettings& o, const std::vector<std::string>& wrong) {
  std::vector<std::string> keys;
  for (const SignalKey& key : signal_keys(o)) {
    if (contains(o.invert, key.key) != contains(wrong, key.key)) keys.push_back(key.key);
  }
  return invert_line(keys);
}

std::string times_text(double times) { return short_number(times) + " times"; }

WheelHint sign_hint(const OdometrySettings& o, const SideFaults& faults, const std::string& seen) {
  const auto keys = signal_keys(o);
  std::string which;
  if (faults.left_sign) which = named(keys[0]);
  if (faults.right_sign) which += (which.empty() ? "" : " and ") + named(keys[1]);
  const bool both = faults.left_sign && faults.right_sign;
  return {"sign", which + (both ? " count" : " counts") + " backwards" + seen,
          side_lines(o, faults)};
}

WheelHint swap_hint(const OdometrySettings& o, const SideFaults& faults, const std::string& seen) {
  return {"swapped", "left and right wheel are swapped: " + seen, side_lines(o, faults)};
}

WheelHint track_hint(const OdometrySettings& o, double times, const std::string& seen) {
  const double track = o.wheels.geometry.track_m * o.wheels.geometry.slip_factor * times;
  const double slip = track / o.wheels.geometry.track_m;
  std::vector<std::string> yaml = {"odometry:", "  track: " + short_number(track)};
  if (o.wheels.geometry.slip_factor != 1) {
    yaml[1] = "  slip_factor: " + short_number(slip);
  }
  return {"track", seen + ": the track is another, or the wheels skid (slip_factor)", yaml};
}

WheelHint silent_hint(const OdometrySettings& o, const SignalKey& key, bool changes,
                      const std::string& seen) {
  if (changes && o.wheels.model == OdometryModel::kDifferentialPositions) {
    return {"speed-as-position",
            named(key) + " always comes back to where it was, " + seen +
                ": it is a speed, and the model reads it as a position",
            {"odometry:", "  model: wheel-speeds"}};
  }
  return {"silent",
          named(key) + " stays as it is, " + seen +
              ": the name, the bits or the id are those of something else, or the drive does not "
              "report",
          {}};
}

}  // namespace zonepack
