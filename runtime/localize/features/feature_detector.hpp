// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "runtime/localize/camera/camera_model.hpp"
#include "runtime/localize/camera/grey_image.hpp"
#include "runtime/localize/features/detector_settings.hpp"
#include "runtime/localize/features/image_features.hpp"

namespace zonepack::localize {

// Finds and describes the features of images as the map's source did, with OpenCV.
//
// Threads: one at a time; OpenCV starts none.
class FeatureDetector {
 public:
  explicit FeatureDetector(const DetectorSettings& settings);
  ~FeatureDetector();

  // `image` is whole.
  ImageFeatures detect(const GreyImage& image, const CameraModel& camera);
  const DetectorSettings& settings() const noexcept { return settings_; }

 private:
  struct OpenCv;
  DetectorSettings settings_;
  std::unique_ptr<OpenCv> cv_;
};

}  // namespace zonepack::localize
