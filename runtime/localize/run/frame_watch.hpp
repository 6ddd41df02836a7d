// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/localize/camera/grey_image.hpp"
#include "runtime/localize/camera/repeat_watch.hpp"

namespace zonepack::localize {

// Judges the images of a camera before they are used: size, stamp, and whether they are new.
class FrameWatch {
 public:
  // A stamp may be this much behind its clock (a fix that is older finds no place in zoned's
  // history), or ahead of it (the clocks are read one after the other).
  static constexpr std::int64_t kMostAge_ns = 5'000'000'000;
  static constexpr std::int64_t kMostAhead_ns = 200'000'000;

  // Of the calibration.
  FrameWatch(int width, int height) : width_(width), height_(height) {}

  // Why the image is of no use; empty: it is. now_ns: its clock, now.
  std::string refuse(const GreyImage& image, std::int64_t now_ns);

 private:
  const int width_, height_;
  bool seen_ = false;
  std::int64_t last_ns_ = 0;
  RepeatWatch repeat_;
};

}  // namespace zonepack::localize
