// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/color.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

// Line colours of middling lightness: legible on white and on a dark page.
constexpr std::array<Color, 8> kOnBoth = {{{0xcc, 0x66, 0x77},
                                           {0xc8, 0x9b, 0x2c},
                                           {0x2b, 0xa0, 0xb8},
                                           {0x99, 0x99, 0x33},
                                           kOursToo,
                                           kOther,
                                           kOtherToo,
                                           kDoor}};

// sRGB and OKLab, by B. Ottosson, "A perceptual color space for image processing".
struct Lab {
  double lightness = 0, a = 0, b = 0;
};

double linear(std::uint8_t value) noexcept {
  const double share = value / 255.0;
  return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}

std::uint8_t gamma(double value) noexcept {
  const double v = std::clamp(value, 0.0, 1.0);
  const double share = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(share * 255 + 0.5);
}

Lab to_lab(Color color) noexcept {
  const double r = linear(color.r), g = linear(color.g), b = linear(color.b);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

Color to_color(const Lab& lab) noexcept {
  const auto cube = [](double v) { return v * v * v; };
  const double l = cube(lab.lightness + 0.3963377774 * lab.a + 0.2158037573 * lab.b);
  const double m = cube(lab.lightness - 0.1055613458 * lab.a - 0.0638541728 * lab.b);
  const double s = cube(lab.lightness - 0.0894841775 * lab.a - 1.2914855480 * lab.b);
  return {gamma(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          gamma(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          gamma(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

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

Color dark_twin(Color color) noexcept {
  if (std::ranges::find(kOnBoth, color) != kOnBoth.end()) return color;
  constexpr double kPage = 0.2, kSpread = 1.05,
                   kMost = 0.94;  // lightness of the twin of white; 1 to 0 on
  Lab lab = to_lab(color);
  lab.lightness = std::min(kPage + (1 - lab.lightness) * kSpread, kMost);
  return to_color(lab);
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
