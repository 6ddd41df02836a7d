// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

// Rows of colour to rows of grey. `from` holds at least as many pixels as `to`.
//
// Real-time: nothing allocates.
namespace zonepack::localize {

// Red, green and blue weighted 0.299, 0.587, 0.114 (ITU-R BT.601, as JPEG and OpenCV do), in whole
// numbers, so that every computer gives the same bits.
constexpr std::uint8_t grey_of(std::uint32_t red, std::uint32_t green,
                               std::uint32_t blue) noexcept {
  return static_cast<std::uint8_t>((red * 4899 + green * 9617 + blue * 1868 + 8192) >> 14);
}

// Three bytes a pixel.
void grey_of_rgb(std::span<const std::uint8_t> from, std::span<std::uint8_t> to) noexcept;
void grey_of_bgr(std::span<const std::uint8_t> from, std::span<std::uint8_t> to) noexcept;
// Y U Y V: two bytes a pixel, the first of which is grey.
void grey_of_yuyv(std::span<const std::uint8_t> from, std::span<std::uint8_t> to) noexcept;

}  // namespace zonepack::localize
