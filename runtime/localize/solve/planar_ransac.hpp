// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "runtime/localize/solve/sighting.hpp"

namespace zonepack::localize {

struct RansacOptions {
  int iterations = 400;      // at most
  int least = 60;            // before it may stop
  double threshold_px = 10;  // wide: a camera tilted by 1 degree moves points by 7 px at fx = 385
  std::uint64_t seed = 1;
  std::size_t most_poses = 1;               // that are given, best first
  double apart_m = 0.06, apart_rad = 0.02;  // between two of them, at least one of these
};

// What a pose must not leave: a box around a guess.
struct PoseGate {
  Pose2 centre;
  double most_m = 0, most_yaw_rad = 0;
};

struct PlanarPose {
  Pose2 pose;
  double score = 0;  // sum over the image's features of 1 - (error / threshold)^2
  int features = 0;  // of the image, within the threshold
};

// The pose of a robot on a floor at this height that most sightings agree with: RANSAC over pairs
// of them (3 degrees of freedom, 4 equations). Sightings are sorted by feature; of several of one
// feature the nearest counts. Also the next best poses, where they are apart. The same sightings
// and seed give the same poses.
std::vector<PlanarPose> find_planar(std::span<const Sighting> sightings, const CameraModel& camera,
                                    double floor_z_m, const PoseGate& gate,
                                    const RansacOptions& options);

// The pose from two sightings, by Gauss and Newton from `start`, or from the floor's geometry where
// both are looked down at. None where they contradict each other.
std::optional<Pose2> pose_of_two(const Sighting& a, const Sighting& b, const CameraModel& camera,
                                 double floor_z_m, const Pose2& start);

}  // namespace zonepack::localize
