// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/inputs/run_start.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "runtime/odometry/det_math.hpp"

namespace zonepack {
namespace {

constexpr double kNear_s = 1.0;
constexpr double kFarthest_m = 1e6;

bool read_number(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

// Truth may begin a little after the bus.
std::optional<Pose2> first_truth(const TruthTrack* truth, std::int64_t start_ns) {
  if (truth == nullptr) return std::nullopt;
  if (const auto pose = truth->at(start_ns)) return pose;
  const TruthTrack::Sample& first = truth->samples().front();
  const bool near =
      first.t_ns > start_ns && static_cast<double>(first.t_ns - start_ns) < kNear_s * 1e9;
  return near ? std::optional(first.T_map_base) : std::nullopt;
}

}  // namespace

std::optional<Pose2> parse_pose(std::string_view text) {
  std::array<double, 3> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t comma = text.find(',');
    const bool last = i + 1 == numbers.size();
    if (last != (comma == std::string_view::npos)) return std::nullopt;
    if (!read_number(text.substr(0, comma), numbers[i])) return std::nullopt;
    if (!last) text.remove_prefix(comma + 1);
  }
  const double yaw_rad = numbers[2] * (kPi / 180);
  if (std::abs(numbers[0]) > kFarthest_m || std::abs(numbers[1]) > kFarthest_m ||
      std::abs(yaw_rad) > kLargestAngle_rad) {
    return std::nullopt;
  }
  return Pose2{numbers[0], numbers[1], wrap_angle(yaw_rad)};
}

std::optional<StartChoice> parse_start(const std::string& text) {
  if (text == "fix") return StartChoice{StartChoice::Kind::kFix, {}};
  if (text == "truth") return StartChoice{StartChoice::Kind::kTruth, {}};
  const auto pose = parse_pose(text);
  return pose ? std::optional(StartChoice{StartChoice::Kind::kPose, *pose}) : std::nullopt;
}

Outcome<std::optional<RunStart>> find_start(const StartChoice& choice, const TruthTrack* truth,
                                            std::int64_t start_ns) {
  using Kind = StartChoice::Kind;
  if (choice.kind == Kind::kFix) return std::optional<RunStart>();
  if (choice.kind == Kind::kPose) return std::optional(RunStart{start_ns, choice.pose});
  const auto pose = first_truth(truth, start_ns);
  if (!pose)
    return failure("--start truth: the truth file does not cover the start of the CAN log");
  return std::optional(RunStart{start_ns, *pose});
}

void start_at(Cycle& cycle, const RunStart& start) {
  if (start.sigma_m && start.sigma_rad) {
    cycle.start_at(start.now_ns, start.T_map_base, *start.sigma_m, *start.sigma_rad);
  } else {
    cycle.start_at(start.now_ns, start.T_map_base);
  }
}

}  // namespace zonepack
