// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "runtime/localize/camera/camera_model.hpp"
#include "runtime/localize/camera/grey_image.hpp"
#include "runtime/localize/features/detector_settings.hpp"
#include "runtime/localize/features/image_features.hpp"

namespace zonepack::localize {

class OrbComparisons;

// What places of an image look like, by their numbers in the list that was asked for.
struct DescribedPlaces {
  std::uint32_t descriptor_bytes = 0;
  std::vector<std::uint8_t> rows;
  std::vector<std::int32_t> row_of;  // -1: too near to the border to be described

  const std::uint8_t* find(std::size_t place) const noexcept {
    const std::int32_t row = row_of[place];
    return row < 0 ? nullptr : rows.data() + static_cast<std::size_t>(row) * descriptor_bytes;
  }
};

// The same of places on a grid: row by row, from the first that is far enough from the border.
struct DescribedGrid {
  std::uint32_t descriptor_bytes = 0;
  int first_px = 0, step_px = 1, columns = 0, rows = 0;
  std::vector<std::uint8_t> descriptors;
};

// Finds and describes the features of images as the map's source did, with OpenCV.
//
// Threads: one at a time; OpenCV starts none.
class FeatureDetector {
 public:
  explicit FeatureDetector(const DetectorSettings& settings);
  ~FeatureDetector();

  // `image` is whole.
  ImageFeatures detect(const GreyImage& image, const CameraModel& camera);

  // Whether a descriptor is of a place alone: others need the size and direction that the detector
  // found there.
  bool describes_anywhere() const noexcept { return settings_.detector == Detector::kGfttOrb; }

  const DetectorSettings& settings() const noexcept { return settings_; }

 private:
  friend class PlaceDescriber;
  struct OpenCv;
  DetectorSettings settings_;
  std::unique_ptr<OpenCv> cv_;
};

// Says what an image looks like at any places, in its own pixels. The image is prepared once, when
// places are asked for first.
//
// Threads: as the detector, of which one describer exists at a time.
// Memory: a byte a pixel of the image.
class PlaceDescriber {
 public:
  // Detector and image outlive it. The image is whole; the detector describes_anywhere().
  PlaceDescriber(FeatureDetector& detector, const GreyImage& image);
  ~PlaceDescriber();
  PlaceDescriber(const PlaceDescriber&) = delete;
  PlaceDescriber& operator=(const PlaceDescriber&) = delete;

  DescribedPlaces places(std::span<const Eigen::Vector2f> px);
  DescribedGrid grid(int step_px);

  const GreyImage& image() const noexcept { return image_; }
  std::uint32_t descriptor_bytes() const noexcept { return settings_.descriptor_bytes(); }

 private:
  // Null: OpenCV describes.
  const OrbComparisons* prepared();

  const GreyImage& image_;
  const DetectorSettings& settings_;
  FeatureDetector::OpenCv& cv_;
  OrbComparisons* comparisons_ = nullptr;
  bool prepared_ = false;
};

}  // namespace zonepack::localize
