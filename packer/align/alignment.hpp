// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "packer/record/source_kind.hpp"

namespace zonepack::packer {

// A camera's pose as a SLAM system left it, in a frame of its own whose unit may be any length.
// The camera looks along its z axis, x is right and y down (the optical frame).
struct KeyframePose {
  double stamp_s = 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

// From a SLAM system's frame into the map's: p_map = scale * (R * p_world) + t.
struct Similarity {
  double metres_per_unit = 1;
  Eigen::Matrix3d R_map_world = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t_map_world = Eigen::Vector3d::Zero();

  Eigen::Vector3d point(const Eigen::Vector3d& p_world) const {
    return metres_per_unit * (R_map_world * p_world) + t_map_world;
  }
  Eigen::Isometry3d pose(const Eigen::Isometry3d& T_world_x) const {
    return Eigen::Translation3d(point(T_world_x.translation())) *
           Eigen::Quaterniond(R_map_world * T_world_x.linear());
  }
};

struct Alignment {
  Similarity into_map;
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  std::vector<std::string> notes;     // how it was found, with residuals; sentences for the user
  std::vector<std::string> warnings;  // what was guessed
};

// Where the optical frame of FramePlacement::camera_in_base stands in the base, and back.
Eigen::Isometry3d optical_in_base(const std::array<double, 6>& camera_in_base);
std::array<double, 6> camera_in_base(const Eigen::Isometry3d& T_base_optical);

// Finds where a map of keyframes stands.
//
// With a trajectory: the similarity that moves the cameras' places onto those of the trajectory at
// the same stamps (Umeyama, "Least-squares estimation of transformation parameters between two
// point patterns", PAMI 1991), fitted to the places that agree. How the camera is turned in the
// base follows from the trajectory too: used where FramePlacement does not say, and warned of where
// it says otherwise. Otherwise the map's frame begins at the first keyframe's base, x forward and z
// up; `metric` says whether the source's unit is a metre.
//
// Throws std::runtime_error where nothing follows: stamps that do not meet, all places on a line.
Alignment align_keyframes(const std::vector<KeyframePose>& keyframes,
                          const FramePlacement& placement, bool metric, const std::string& source);

}  // namespace zonepack::packer
