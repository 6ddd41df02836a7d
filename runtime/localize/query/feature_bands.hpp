// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "runtime/localize/features/image_features.hpp"
#include "runtime/localize/query/search_windows.hpp"

namespace zonepack::localize {

// The features of an image in bands across it, each sorted from left to right, their descriptors
// side by side: what a window covers is one run in each of the bands that it touches.
class FeatureBands {
 public:
  explicit FeatureBands(const ImageFeatures& image)
      : bytes_(image.descriptor_bytes), bands_(image.height / kBand_px + 1) {
    std::vector<std::vector<std::uint32_t>> of_band(static_cast<std::size_t>(bands_));
    for (std::uint32_t i = 0; i < image.size(); ++i) {
      of_band[static_cast<std::size_t>(band_of(image.px[i].y()))].push_back(i);
    }
    descriptors_.reserve(image.descriptors.size());
    for (const std::vector<std::uint32_t>& band : of_band) {
      first_.push_back(static_cast<std::uint32_t>(features_.size()));
      for (const std::uint32_t feature : band) {
        features_.push_back(feature);
        x_.push_back(image.px[feature].x());
        y_.push_back(image.px[feature].y());
        const std::uint8_t* const row = image.descriptor(feature);
        descriptors_.insert(descriptors_.end(), row, row + bytes_);
      }
    }
    first_.push_back(static_cast<std::uint32_t>(features_.size()));
    distances_.resize(features_.size());
  }

  // Calls fn(feature, distance) for each feature in the window. distances(rows, count, out) is
  // given `count` descriptors back to back.
  template <typename Distances, typename Fn>
  void for_each_inside(const SearchWindows::Window& window, Distances&& distances, Fn&& fn) {
    const Eigen::Vector2f from = window.middle - window.half, to = window.middle + window.half;
    const int last = band_of(to.y());
    for (int band = band_of(from.y()); band <= last; ++band) {
      const auto begin = x_.begin() + first_[static_cast<std::size_t>(band)];
      const auto end = x_.begin() + first_[static_cast<std::size_t>(band) + 1];
      const auto left =
          static_cast<std::size_t>(std::lower_bound(begin, end, from.x()) - x_.begin());
      const auto right =
          static_cast<std::size_t>(std::upper_bound(begin, end, to.x()) - x_.begin());
      distances(descriptors_.data() + left * bytes_, right - left, distances_.data());
      for (std::size_t i = left; i < right; ++i) {
        if (y_[i] >= from.y() && y_[i] <= to.y()) fn(features_[i], distances_[i - left]);
      }
    }
  }

 private:
  static constexpr int kBand_px = 48;
  int band_of(float y_px) const {
    return std::clamp(static_cast<int>(std::clamp(y_px / kBand_px, -1.0F, 1e6F)), 0, bands_ - 1);
  }

  std::size_t bytes_;
  int bands_;
  std::vector<std::uint32_t> first_;     // of each band, and the end
  std::vector<std::uint32_t> features_;  // by band
  std::vector<float> x_, y_;
  std::vector<std::uint8_t> descriptors_;
  std::vector<std::uint16_t> distances_;
};

}  // namespace zonepack::localize
