// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/color.hpp"

#include <algorithm>
#include <array>

namespace zonepack::report {
namespace {

constexpr std::array<Color, 5> kRamp = {{{0xf4, 0xf8, 0xf1},
                                         {0xcb, 0xe8, 0xd0},
                                         {0x93, 0xd0, 0xc4},
                                         {0x57, 0xb0, 0xbf},
                                         {0x2f, 0x8c, 0xb0}}};

constexpr std::array<Color, kHueCount> kHues = {{{0x33, 0x66, 0xaa},
                                                 {0xcc, 0x66, 0x77},
                                                 {0x11, 0x77, 0x33},
                                                 {0xc8, 0x9b, 0x2c},
                                                 {0x88, 0x22, 0x55},
                                                 {0x2b, 0xa0, 0xb8},
                                                 {0x99, 0x99, 0x33},
                                                 {0xaa, 0x44, 0x99},
                                                 {0xb8, 0x54, 0x28}}};

std::uint8_t blend(std::uint8_t a, std::uint8_t b, double weight) noexcept {
  return static_cast<std::uint8_t>(a + (b - a) * weight + 0.5);
}

}  // namespace

std::string to_hex(Color color) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "#";
  for (const unsigned value : {color.r, color.g, color.b}) {
    text += kDigits[value >> 4];
    text += kDigits[value & 15];
  }
  return text;
}

Color mix(Color a, Color b, double weight) noexcept {
  const double w = weight > 0 ? std::min(weight, 1.0) : 0.0;
  return {blend(a.r, b.r, w), blend(a.g, b.g, w), blend(a.b, b.b, w)};
}

Color ink_on(Color background) noexcept {
  const double light = 0.299 * background.r + 0.587 * background.g + 0.114 * background.b;
  return light > 110 ? kInk : kWhite;
}

Color ramp_color(double share) noexcept {
  const double place = share > 0 ? std::min(share, 1.0) * (kRamp.size() - 1) : 0.0;
  const std::size_t low = std::min(static_cast<std::size_t>(place), kRamp.size() - 2);
  return mix(kRamp[low], kRamp[low + 1], place - static_cast<double>(low));
}

Color hue(std::size_t index) noexcept { return kHues[index % kHueCount]; }

}  // namespace zonepack::report
