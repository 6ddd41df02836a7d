// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace zonepack::localize {

// "640x480".
inline std::string size_text(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

// An 8-bit image, row by row without gaps, and when it was taken.
struct GreyImage {
  int width = 0, height = 0;
  std::int64_t stamp_ns = 0;  // the source's clock
  std::vector<std::uint8_t> pixels;

  bool whole() const noexcept {
    return width > 0 && height > 0 &&
           pixels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

}  // namespace zonepack::localize
