// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace zonepack::localize {

// The features of an image: where they are, and what they look like. Sorted by px.x().
struct ImageFeatures {
  int width = 0, height = 0;
  std::int64_t stamp_ns = 0;
  std::vector<Eigen::Vector2f> seen_px;  // in the image
  std::vector<Eigen::Vector2f> px;       // as an ideal pinhole camera would see them
  std::uint32_t descriptor_bytes = 0;
  std::vector<std::uint8_t> descriptors;
  std::int64_t detect_ns = 0, describe_ns = 0;  // thread-CPU time

  std::size_t size() const noexcept { return px.size(); }
  const std::uint8_t* descriptor(std::size_t index) const noexcept {
    return descriptors.data() + index * descriptor_bytes;
  }
};

}  // namespace zonepack::localize
