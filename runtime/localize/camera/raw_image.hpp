// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "platform/base/byte_span.hpp"
#include "platform/base/failure.hpp"
#include "runtime/localize/camera/grey_image.hpp"

namespace zonepack::localize {

// As the camera's socket numbers them.
enum class PixelFormat : std::uint8_t { kGrey, kRgb, kBgr, kYuyv, kJpeg };

// An image as a device or another program gave it.
struct RawImage {
  PixelFormat format = PixelFormat::kGrey;
  int width = 0, height = 0;
  std::uint32_t row_bytes = 0;  // from a row to the next; not of a JPEG
  ByteSpan bytes;
};

// Bytes that a row takes at least; 0 for a JPEG.
std::uint32_t least_row_bytes(PixelFormat format, int width) noexcept;

// Makes it grey, in memory that is used again. Fails, with `name` in front, when bytes are missing
// or a JPEG is damaged or of another size.
Outcome<void> to_grey(const RawImage& raw, const std::string& name, GreyImage& into);

}  // namespace zonepack::localize
