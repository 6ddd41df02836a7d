// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/odometry/pose.hpp"

namespace zonepack::localize {

// What another localizer found on the same images, to be shown next to ours.
struct BesideRun {
  struct Fix {
    std::int64_t stamp_ns = 0;
    Pose2 T_map_base;
  };
  std::string name;        // "RTAB-Map", or the file's
  std::size_t images = 0;  // that it looked at; 0: not known
  std::vector<Fix> fixes;
};

// Reads a recorded run of RTAB-Map (CSV; of its columns t, accepted, mx, my and myaw are used: a
// row whose `accepted` is not 0 is a fix) or a list of poses as TUM's (`t x y z qx qy qz qw`), each
// of which is a fix.
Outcome<BesideRun> read_beside(const std::string& path);

}  // namespace zonepack::localize
