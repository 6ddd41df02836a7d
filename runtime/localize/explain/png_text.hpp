// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "runtime/localize/camera/grey_image.hpp"

namespace zonepack::localize {

// The image as a PNG file.
std::string png_text(const GreyImage& image);

}  // namespace zonepack::localize
