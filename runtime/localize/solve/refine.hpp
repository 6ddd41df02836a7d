// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "runtime/localize/solve/sighting.hpp"
#include "runtime/odometry/pose.hpp"

namespace zonepack::localize {

// A robot drives on a floor, nearly: standard deviations of its height and tilt. Wide enough for a
// mount that is a degree off, and narrow enough to help where the points lie on one side.
struct PlanePrior {
  double floor_z_m = 0;
  double sigma_z_m = 0.01;
  double sigma_tilt_rad = 0.7 * 3.14159265358979 / 180;
};

struct RefineOptions {
  double start_px = 8;  // scale of the robust loss at the start …
  double end_px = 2;    // … and at the end
  int steps = 12;
  double sigma_px = 1;  // of a sighting
};

struct Refined {
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  Covariance2 covariance;  // of x, y, yaw, with the others free within the priors
  bool valid = false;
};

// The pose in six degrees of freedom that explains the sightings best: Gauss and Newton with Geman
// and McClure's weights, whose scale shrinks from step to step, and priors of the plane. The
// covariance is the inverse of the information matrix.
Refined refine(std::span<const Sighting> sightings, const CameraModel& camera,
               const Eigen::Isometry3d& start, const PlanePrior& prior,
               const RefineOptions& options = {});

}  // namespace zonepack::localize
