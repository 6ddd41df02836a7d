// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace zonepack::packer {

struct PlanPicture {
  std::size_t width = 0, height = 0;
  // Top row first, 0 black to 255 white; colours as the mean of red, green and blue.
  std::vector<std::uint8_t> pixels;
  std::vector<std::uint8_t> opacity;  // empty where all is opaque
};

// Reads a PGM (P2 or P5) or PNG file of at most `most_pixels`, known by its first bytes. Sizes are
// checked before memory is taken for them. Throws std::runtime_error that names the file.
PlanPicture read_plan_picture(const std::string& path, std::size_t most_pixels);

}  // namespace zonepack::packer
