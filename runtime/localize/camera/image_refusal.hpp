// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "platform/base/byte_span.hpp"
#include "platform/base/failure.hpp"
#include "runtime/localize/camera/grey_image.hpp"

// Shared by the decoders of each kind of image.
namespace zonepack::localize {

// "FILE: is a JPEG that ends early; expected …". `detail` is the library's own word for it.
Failure refused_image(const std::string& name, std::string_view kind, std::string_view what,
                      std::string_view detail = {});

// Fails for an image without pixels or with a side over kMostImageSide_px.
Outcome<void> check_image_size(const std::string& name, std::uint64_t width, std::uint64_t height);

Outcome<void> decode_png(ByteSpan bytes, const std::string& name, GreyImage& into);

}  // namespace zonepack::localize
