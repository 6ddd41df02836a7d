// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>

#include "runtime/localize/camera/camera_model.hpp"
#include "runtime/localize/camera/grey_image.hpp"
#include "runtime/localize/features/feature_detector.hpp"
#include "runtime/localize/features/image_features.hpp"
#include "runtime/localize/query/map_features.hpp"
#include "runtime/localize/solve/sighting.hpp"
#include "tests/unit/runtime/localize/solve/made_sightings.hpp"

// An image made up, and the map that a camera which took it would make.
namespace zonepack::localize {

inline constexpr Pose2 kPlace{3, -2, 0.7};

// 400 boxes of any grey at any place: corners everywhere, none like another.
inline GreyImage made_view() {
  GreyImage image;
  image.width = 640;
  image.height = 480;
  image.pixels.assign(640 * 480, 128);
  std::mt19937 random(5);
  for (int box = 0; box < 400; ++box) {
    const auto left = static_cast<int>(random() % 620), top = static_cast<int>(random() % 460);
    const auto wide = static_cast<int>(10 + random() % 50),
               high = static_cast<int>(10 + random() % 50);
    const auto grey = static_cast<std::uint8_t>(random() % 256);
    for (int y = top; y < std::min(480, top + high); ++y) {
      for (int x = left; x < std::min(640, left + wide); ++x) {
        image.pixels[static_cast<std::size_t>(y * 640 + x)] = grey;
      }
    }
  }
  return image;
}

// A signature that took the image at kPlace: each feature at a depth of 1 to 5 m.
inline MapFeatures made_signature(const ImageFeatures& features, const CameraModel& camera,
                                  std::uint32_t descriptor_bytes) {
  MapFeatures map;
  map.id = 7;
  map.zone = 0;
  map.T_map_base = lift(kPlace, 0);
  map.T_base_camera = camera.T_base_camera;
  map.descriptor_bytes = descriptor_bytes;
  map.descriptors = features.descriptors;
  std::mt19937 random(9);
  for (const Eigen::Vector2f& px : features.px) {
    const double depth = 1 + static_cast<double>(random() % 4000) / 1000;
    const Eigen::Vector3d p =
        camera.T_base_camera * Eigen::Vector3d((double{px.x()} - camera.cx) / camera.fx * depth,
                                               (double{px.y()} - camera.cy) / camera.fy * depth,
                                               depth);
    map.points.push_back({px.x(), px.y(), static_cast<float>(p.x()), static_cast<float>(p.y()),
                          static_cast<float>(p.z())});
  }
  return map;
}

// The image, its features and the map of them.
struct MadeView {
  const CameraModel camera_ = made_camera();
  const GreyImage view_ = made_view();
  FeatureDetector detector_{DetectorSettings{}};
  const ImageFeatures features_ = detector_.detect(view_, camera_);
  const MapFeatures map_ =
      made_signature(features_, camera_, detector_.settings().descriptor_bytes());
};

}  // namespace zonepack::localize
