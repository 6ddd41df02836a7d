// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/run/frame_watch.hpp"

#include <cstdio>

namespace zonepack::localize {
namespace {

std::string age_text(std::int64_t ns) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3f s", static_cast<double>(ns) / 1e9);
  return text;
}

// Without overflow, whatever the stamps are.
std::int64_t bounded_minus(std::int64_t a, std::int64_t b) noexcept {
  std::int64_t difference = 0;
  if (__builtin_sub_overflow(a, b, &difference)) return a < b ? INT64_MIN : INT64_MAX;
  return difference;
}

}  // namespace

std::string FrameWatch::refuse(const GreyImage& image, std::int64_t now_ns) {
  if (!image.whole() || image.width != width_ || image.height != height_) {
    return "an image of " + size_text(image.width, image.height) + "; the calibration is of " +
           size_text(width_, height_);
  }
  const std::int64_t age_ns = bounded_minus(now_ns, image.stamp_ns);
  if (age_ns > kMostAge_ns) {
    return "an image's stamp is " + age_text(age_ns) +
           " behind its clock; expected the time of the exposure, on the clock that is named";
  }
  if (age_ns < -kMostAhead_ns) {
    return "an image's stamp is " + age_text(bounded_minus(0, age_ns)) +
           " ahead of its clock; expected the time of the exposure, on the clock that is named";
  }
  if (seen_ && image.stamp_ns <= last_ns_) {
    return "an image's stamp " + age_text(image.stamp_ns) + " does not rise over the one before, " +
           age_text(last_ns_);
  }
  seen_ = true;
  last_ns_ = image.stamp_ns;
  if (repeat_.repeats(image)) {
    return "an image is the one before, bit for bit: the camera repeats itself";
  }
  return {};
}

}  // namespace zonepack::localize
