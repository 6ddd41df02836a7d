// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/grey_rows.hpp"

namespace zonepack::localize {

void grey_of_rgb(std::span<const std::uint8_t> from, std::span<std::uint8_t> to) noexcept {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i] = grey_of(from[3 * i], from[3 * i + 1], from[3 * i + 2]);
  }
}

void grey_of_bgr(std::span<const std::uint8_t> from, std::span<std::uint8_t> to) noexcept {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i] = grey_of(from[3 * i + 2], from[3 * i + 1], from[3 * i]);
  }
}

void grey_of_yuyv(std::span<const std::uint8_t> from, std::span<std::uint8_t> to) noexcept {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = from[2 * i];
}

}  // namespace zonepack::localize
