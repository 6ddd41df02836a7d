// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "runtime/localize/features/image_features.hpp"

namespace zonepack::localize {

// The features of an image by place, so that those near a point are found without looking at all.
class FeatureGrid {
 public:
  explicit FeatureGrid(const ImageFeatures& image)
      : image_(&image), columns_(image.width / kCell + 1), rows_(image.height / kCell + 1) {
    first_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
    for (std::size_t i = 0; i < image.size(); ++i) ++first_[cell_of(i) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    features_.resize(image.size());
    for (std::size_t i = 0; i < image.size(); ++i) {
      features_[next[cell_of(i)]++] = static_cast<std::uint32_t>(i);
    }
  }

  // Calls fn(feature) for each within `radius` of (x, y), in the order of cells.
  template <typename Fn>
  void for_each_near(float x, float y, float radius, Fn&& fn) const {
    const int left = clamp((x - radius) / kCell, columns_),
              right = clamp((x + radius) / kCell, columns_);
    const int top = clamp((y - radius) / kCell, rows_), bottom = clamp((y + radius) / kCell, rows_);
    for (int row = top; row <= bottom; ++row) {
      const auto line = static_cast<std::size_t>(row * columns_);
      const std::uint32_t end = first_[line + static_cast<std::size_t>(right) + 1];
      for (std::uint32_t at = first_[line + static_cast<std::size_t>(left)]; at < end; ++at) {
        const Eigen::Vector2f& px = image_->px[features_[at]];
        const float dx = px.x() - x, dy = px.y() - y;
        if (dx * dx + dy * dy <= radius * radius) fn(features_[at]);
      }
    }
  }

 private:
  static constexpr int kCell = 16;  // pixels
  static int clamp(float cell, int count) {
    return std::clamp(static_cast<int>(std::clamp(cell, -1.0F, 1e6F)), 0, count - 1);
  }
  std::size_t cell_of(std::size_t feature) const {
    const Eigen::Vector2f& px = image_->px[feature];
    return static_cast<std::size_t>(clamp(px.y() / kCell, rows_) * columns_ +
                                    clamp(px.x() / kCell, columns_));
  }

  const ImageFeatures* image_;
  int columns_, rows_;
  std::vector<std::uint32_t> first_;     // of each cell, and the end
  std::vector<std::uint32_t> features_;  // by cell
};

}  // namespace zonepack::localize
