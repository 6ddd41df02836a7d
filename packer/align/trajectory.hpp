// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <vector>

namespace zonepack::packer {

struct StampedPose {
  double stamp_s = 0;
  Eigen::Isometry3d T_frame_base = Eigen::Isometry3d::Identity();
};

// A TUM trajectory: a line each pose, "stamp x y z qx qy qz qw", separated by blanks, tabs or
// commas; lines that begin with # are comments, one line of column names is left out.
class Trajectory {
 public:
  // Throws std::runtime_error with file and line for anything else: numbers that are not finite,
  // a quaternion of no length, stamps that do not ascend, more than 256 MiB.
  static Trajectory read(const std::filesystem::path& file);

  const std::vector<StampedPose>& poses() const noexcept { return poses_; }

  // The pose at a time, linear between the two around it; none before the first, behind the last,
  // and where they are more than a second apart.
  std::optional<Eigen::Isometry3d> at(double stamp_s) const;

 private:
  std::vector<StampedPose> poses_;  // ascending stamps
};

}  // namespace zonepack::packer
