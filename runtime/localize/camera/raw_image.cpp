// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/raw_image.hpp"

#include <algorithm>

#include "runtime/localize/camera/grey_image.hpp"
#include "runtime/localize/camera/grey_rows.hpp"
#include "runtime/localize/camera/image_file.hpp"

namespace zonepack::localize {
namespace {

using RowConversion = void (*)(std::span<const std::uint8_t>, std::span<std::uint8_t>);

void copy_row(std::span<const std::uint8_t> from, std::span<std::uint8_t> to) noexcept {
  std::copy_n(from.begin(), to.size(), to.begin());
}

RowConversion row_of(PixelFormat format) noexcept {
  switch (format) {
    case PixelFormat::kRgb:
      return grey_of_rgb;
    case PixelFormat::kBgr:
      return grey_of_bgr;
    case PixelFormat::kYuyv:
      return grey_of_yuyv;
    default:
      return copy_row;
  }
}

}  // namespace

std::uint32_t least_row_bytes(PixelFormat format, int width) noexcept {
  const auto pixels = static_cast<std::uint32_t>(width);
  switch (format) {
    case PixelFormat::kGrey:
      return pixels;
    case PixelFormat::kRgb:
    case PixelFormat::kBgr:
      return 3 * pixels;
    case PixelFormat::kYuyv:
      return 2 * pixels;
    case PixelFormat::kJpeg:
      break;
  }
  return 0;
}

Outcome<void> to_grey(const RawImage& raw, const std::string& name, GreyImage& into) {
  if (raw.format == PixelFormat::kJpeg) {
    if (auto decoded = decode_jpeg(raw.bytes, name, into); !decoded) return decoded;
    if (into.width == raw.width && into.height == raw.height) return {};
    return failure(name + ": its JPEG is " + size_text(into.width, into.height) +
                   " pixels; expected " + size_text(raw.width, raw.height));
  }
  const auto width = static_cast<std::size_t>(raw.width);
  const auto height = static_cast<std::size_t>(raw.height);
  const std::size_t least = least_row_bytes(raw.format, raw.width);
  const std::size_t needed = std::size_t{raw.row_bytes} * (height - 1) + least;
  if (raw.row_bytes < least || raw.bytes.size() < needed) {
    return failure(name + ": an image of " + size_text(raw.width, raw.height) + " has " +
                       std::to_string(raw.bytes.size()) + " bytes; expected " +
                       std::to_string(needed) + " or more",
                   ErrorCode::kTruncated);
  }
  into.width = raw.width;
  into.height = raw.height;
  into.pixels.resize(width * height);
  const RowConversion convert = row_of(raw.format);
  const std::span from(reinterpret_cast<const std::uint8_t*>(raw.bytes.data()), raw.bytes.size());
  for (std::size_t y = 0; y < height; ++y) {
    convert(from.subspan(y * raw.row_bytes, least),
            std::span(into.pixels).subspan(y * width, width));
  }
  return {};
}

}  // namespace zonepack::localize
