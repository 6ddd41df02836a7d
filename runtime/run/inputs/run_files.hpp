// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/odometry/pose.hpp"
#include "runtime/odometry/pose_filter.hpp"

// The text files that come with a recorded run. One record a line, columns apart by blanks, tabs,
// commas or semicolons; empty lines, lines beginning with # or % and a first line of column names
// are passed over, as are a byte order mark and CR. Stamps are seconds, read to the nanosecond, or
// whole nanoseconds (18 digits or more).
// Failures name file:line, what was found, which columns are expected.
namespace zonepack {

// `stamp received x y yaw sigma_x sigma_y sigma_yaw`: seconds, metres, radians; base_link in map.
// In order of reception (lines of equal `received` keep their order). Poses and sigmas may be
// anything a number can be, nan too: judging them is the filter's part.
Outcome<std::vector<PoseCorrection>> read_corrections(const std::string& path);
// The same in the order of the file.
Outcome<std::vector<PoseCorrection>> read_corrections_as_written(const std::string& path);

// Where the robot really was.
class TruthTrack {
 public:
  struct Sample {
    std::int64_t t_ns = 0;
    Pose2 T_map_base;
  };

  // Samples in order of time, at least one.
  explicit TruthTrack(std::vector<Sample> samples);

  // The pose at t_ns: straight between samples, yaw the short way; nullopt before the first sample
  // and after the last.
  std::optional<Pose2> at(std::int64_t t_ns) const noexcept;

  const std::vector<Sample>& samples() const noexcept { return samples_; }

 private:
  std::vector<Sample> samples_;
};

// `t x y z qx qy qz qw`, further columns ignored; stamps must not step back. z is not used; of the
// rotation (a unit quaternion to 1 %) only the heading. A first line of column names, with or
// without #, may say that qw comes first, as EuRoC's does.
Outcome<TruthTrack> read_truth(const std::string& path);

}  // namespace zonepack
