// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/explain/png_text.hpp"

#include <png.h>

namespace zonepack::localize {

std::string png_text(const GreyImage& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_GRAY;
  std::string out;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  out.resize(size);
  if (png_image_write_to_memory(&header, out.data(), &size, 0, image.pixels.data(), 0, nullptr) ==
      0) {
    size = 0;
  }
  out.resize(size);
  return out;
}

}  // namespace zonepack::localize
