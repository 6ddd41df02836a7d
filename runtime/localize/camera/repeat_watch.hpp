// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "runtime/localize/camera/grey_image.hpp"
#include "runtime/pack_format/file/checksum.hpp"

namespace zonepack::localize {

// Notices a camera that hangs: it gives the same image over and over, while the noise of a working
// one is never the same twice.
class RepeatWatch {
 public:
  // Whether the image is the one before, bit for bit, as far as 64 bits of checksum say.
  bool repeats(const GreyImage& image) noexcept {
    const Last now{image.width, image.height, xxh3(std::as_bytes(std::span(image.pixels)))};
    const bool same = last_ == now;
    last_ = now;
    return same;
  }

 private:
  struct Last {
    int width = 0, height = 0;
    std::uint64_t pixels = 0;
    friend bool operator==(const Last&, const Last&) = default;
  };
  std::optional<Last> last_;
};

}  // namespace zonepack::localize
