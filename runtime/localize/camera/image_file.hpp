// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "platform/base/byte_span.hpp"
#include "platform/base/failure.hpp"
#include "runtime/localize/camera/grey_image.hpp"

// Still images to grey, by libjpeg-turbo and libpng.
//
// A JPEG's luma is taken as it is stored; other colours are weighted as grey_rows.hpp does. What is
// refused, by name: CMYK, other than 8 bits a channel, a file that ends early or is damaged. A
// failure begins with the file's name.
// Memory: checked before it is taken. The file, at most kMostImageBytes; the image, at most
// kMostImageSide_px squared; for a progressive JPEG and an interlaced PNG also kMostDecoderBytes.
namespace zonepack::localize {

inline constexpr int kMostImageSide_px = 4096;
inline constexpr std::uint64_t kMostImageBytes = std::uint64_t{32} << 20;
inline constexpr std::uint64_t kMostDecoderBytes = std::uint64_t{64} << 20;

// Its stamp_ns is 0.
Outcome<GreyImage> read_image(const std::string& file);

// The same of a file's bytes; `name` stands in messages.
Outcome<GreyImage> decode_image(ByteSpan bytes, const std::string& name);

// Of a JPEG only, into an image whose memory is used again.
Outcome<void> decode_jpeg(ByteSpan bytes, const std::string& name, GreyImage& into);

}  // namespace zonepack::localize
