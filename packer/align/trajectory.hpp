// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "packer/align/umeyama.hpp"

namespace zonepack::packer {

struct TimedPosition {
  double stamp = 0;  // seconds
  Point3 p{};        // metres
};

// Positions over time, by ascending stamp.
class Trajectory {
 public:
  // Reads a TUM trajectory: a line for each pose, "stamp x y z qx qy qz qw", seconds and metres;
  // empty lines and those that begin with # are skipped, orientations are checked and left alone.
  // Throws std::runtime_error that names the file and the line.
  static Trajectory read(const std::filesystem::path& path);

  explicit Trajectory(std::vector<TimedPosition> positions);

  const std::vector<TimedPosition>& positions() const noexcept { return positions_; }

  // The position whose stamp is nearest, if it is at most `tolerance_s` away.
  std::optional<Point3> at(double stamp, double tolerance_s) const;

 private:
  std::vector<TimedPosition> positions_;
};

// Stamps of the same keyframe may differ by so much: writers of trajectories print microseconds to
// hundredths of a second.
inline constexpr double kStampTolerance_s = 0.01;

}  // namespace zonepack::packer
