// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/localize/camera/grey_image.hpp"

namespace zonepack::localize {

// Notices a camera that hangs: it gives the same image over and over, while the noise of a working
// one is never the same twice.
//
// Memory: the pixels of the last image.
class RepeatWatch {
 public:
  // Whether the image is the one before, bit for bit.
  bool repeats(const GreyImage& image) {
    if (seen_ && image.width == width_ && image.height == height_ && image.pixels == last_) {
      return true;
    }
    seen_ = true;
    width_ = image.width;
    height_ = image.height;
    last_ = image.pixels;
    return false;
  }

 private:
  bool seen_ = false;
  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> last_;
};

}  // namespace zonepack::localize
