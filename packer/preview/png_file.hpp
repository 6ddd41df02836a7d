// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace zonepack::packer {

struct PngColor {
  std::uint8_t r = 0, g = 0, b = 0;
  std::uint8_t opacity = 255;
};

// A PNG file of four colours (RFC 2083, indexed, two bits a pixel), top row first; pixels are
// indices into the palette, `width` a row. The same zlib gives the same bytes.
std::string to_png(std::span<const std::uint8_t> pixels, std::size_t width,
                   const std::array<PngColor, 4>& palette);

}  // namespace zonepack::packer
