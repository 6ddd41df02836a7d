// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "runtime/odometry/pose.hpp"

namespace zonepack::localize {

// Where to look: one of these, or the whole map.
struct QueryPlace {
  std::optional<Pose2> near;
  std::string zone;
  bool lost = false;
};

struct QueryArguments {
  std::string map, image, calibration;
  QueryPlace place;
  std::string draw, json;
};

// Finds one image's pose in a map, prints it and why there is none, and returns the exit code: 0
// also where there is none.
int run_query(const QueryArguments& arguments);

}  // namespace zonepack::localize
