// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "runtime/odometry/wheel_model.hpp"

namespace zonepack {

// What somebody does with the robot while its signals are watched.
struct ExpectedMotion {
  enum class Kind { kForward, kBackward, kLeft, kRight, kLeftWheel, kRightWheel };
  Kind kind = Kind::kForward;
  // Metres of forward and backward, degrees of a turn on the spot, turns of a wheel; over 0.
  std::optional<double> amount;
  std::string text;  // as it was given
};

// "forward", "left=90", "right-wheel=1"; nothing for other texts.
std::optional<ExpectedMotion> parse_expected_motion(const std::string& text);

// What is to be done, for people: "drive 2 m forward", "turn the left wheel forward by hand".
std::string instruction_text(const ExpectedMotion& expected);

// Which way signal `index` must go: 1, -1, or 0 when it stands still or the model does not say.
int expected_sign(OdometryModel model, ExpectedMotion::Kind kind, std::size_t index) noexcept;

}  // namespace zonepack
