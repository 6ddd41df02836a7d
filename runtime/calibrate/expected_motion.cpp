// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/expected_motion.hpp"

#include <charconv>
#include <string_view>
#include <utility>

#include "platform/base/number_text.hpp"

namespace zonepack {
namespace {

using MotionKind = ExpectedMotion::Kind;

constexpr std::pair<std::string_view, MotionKind> kWords[] = {
    {"forward", MotionKind::kForward},
    {"backward", MotionKind::kBackward},
    {"left", MotionKind::kLeft},
    {"right", MotionKind::kRight},
    {"left-wheel", MotionKind::kLeftWheel},
    {"right-wheel", MotionKind::kRightWheel}};

}  // namespace

std::optional<ExpectedMotion> parse_expected_motion(const std::string& text) {
  const std::string_view all = text;
  const std::size_t at = all.find('=');
  for (const auto& [word, kind] : kWords) {
    if (all.substr(0, at) != word) continue;
    ExpectedMotion expected{kind, std::nullopt, text};
    if (at == std::string_view::npos) return expected;
    const std::string_view number = all.substr(at + 1);
    double amount = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), amount);
    if (error != std::errc() || end != number.data() + number.size()) return std::nullopt;
    if (!(amount > 0 && amount < 1e6)) return std::nullopt;
    expected.amount = amount;
    return expected;
  }
  return std::nullopt;
}

std::string instruction_text(const ExpectedMotion& expected) {
  const auto of = [&expected](const char* before, const char* unit, const char* after) {
    const std::string amount =
        expected.amount ? " " + short_number(*expected.amount) + " " + unit : std::string();
    return before + amount + after;
  };
  switch (expected.kind) {
    case MotionKind::kForward:
      return of("drive", "m", " forward");
    case MotionKind::kBackward:
      return of("drive", "m", " backward");
    case MotionKind::kLeft:
      return of("turn on the spot", "degrees", " to the left (counter-clockwise)");
    case MotionKind::kRight:
      return of("turn on the spot", "degrees", " to the right (clockwise)");
    case MotionKind::kLeftWheel:
      return of("turn the left wheel, and only it,", "turns", " forward by hand");
    case MotionKind::kRightWheel:
      break;
  }
  return of("turn the right wheel, and only it,", "turns", " forward by hand");
}

int expected_sign(OdometryModel model, MotionKind kind, std::size_t index) noexcept {
  using Model = OdometryModel;
  const bool ahead = kind == MotionKind::kForward || kind == MotionKind::kBackward;
  const bool turn = kind == MotionKind::kLeft || kind == MotionKind::kRight;
  const int way = kind == MotionKind::kBackward || kind == MotionKind::kRight ? -1 : 1;
  switch (model) {
    case Model::kTwist:
      if (ahead) return index == 0 ? way : 0;
      return turn && index == 1 ? way : 0;
    case Model::kAckermannPositions:
    case Model::kAckermannSpeeds:
      return ahead && index == 0 ? way : 0;  // it cannot turn on the spot
    case Model::kOmniPositions:
    case Model::kOmniSpeeds:
      return turn ? way : 0;
    case Model::kDifferentialPositions:
    case Model::kWheelSpeeds:
    case Model::kMecanumPositions:
    case Model::kMecanumSpeeds:
      break;
  }
  const bool left = index % 2 == 0;  // also of mecanum: front left, front right, rear left ...
  if (ahead) return way;
  if (turn) return left ? -way : way;
  return left == (kind == MotionKind::kLeftWheel) ? 1 : 0;
}

}  // namespace zonepack
