// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "runtime/localize/solve/sighting.hpp"

// A camera half a metre over the floor that looks forward, and what it sees of made-up points.
namespace zonepack::localize {

inline CameraModel made_camera() {
  CameraModel camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 385;
  camera.cx = 319.5;
  camera.cy = 239.5;
  camera.T_base_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  camera.T_base_camera.translation() = Eigen::Vector3d(0.2, 0, 0.5);
  return camera;
}

// `count` points in view of a base at the pose, on the floor and on walls; exact.
inline std::vector<Sighting> made_sightings(const CameraModel& camera,
                                            const Eigen::Isometry3d& T_map_base,
                                            std::size_t count) {
  std::mt19937 random(3);
  const auto part = [&] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<Sighting> out;
  while (out.size() < count) {
    const Eigen::Vector2d px(640 * part(), 480 * part());
    const double depth = 1 + 5 * part();
    const Eigen::Vector3d p_camera((px.x() - camera.cx) / camera.fx * depth,
                                   (px.y() - camera.cy) / camera.fy * depth, depth);
    Sighting sighting;
    sighting.p_map = T_map_base * (camera.T_base_camera * p_camera);
    sighting.px = px;
    sighting.feature = static_cast<std::uint32_t>(out.size());
    out.push_back(sighting);
  }
  return out;
}

// Moves every k-th sighting's pixel far away.
inline void spoil(std::vector<Sighting>& sightings, std::size_t every) {
  for (std::size_t i = 0; i < sightings.size(); i += every) {
    sightings[i].px.x() =
        sightings[i].px.x() < 320 ? sightings[i].px.x() + 200 : sightings[i].px.x() - 200;
  }
}

}  // namespace zonepack::localize
