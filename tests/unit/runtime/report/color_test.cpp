// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/color.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace zonepack::report {
namespace {

double channel(std::uint8_t value) {
  const double c = value / 255.0;
  return c <= 0.03928 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

// Relative luminance and contrast as WCAG 2 defines them.
double luminance(Color c) {
  return 0.2126 * channel(c.r) + 0.7152 * channel(c.g) + 0.0722 * channel(c.b);
}

double contrast(Color a, Color b) {
  const double la = luminance(a), lb = luminance(b);
  return (std::max(la, lb) + 0.05) / (std::min(la, lb) + 0.05);
}

TEST(Color, HexIsLowerCaseAndPadded) { EXPECT_EQ(to_hex({0x0b, 0xff, 0x00}), "#0bff00"); }

TEST(Color, MixIsLinearAndBounded) {
  EXPECT_EQ(mix({0, 0, 0}, {200, 100, 50}, 0.5), (Color{100, 50, 25}));
  EXPECT_EQ(mix({10, 10, 10}, {0, 0, 0}, 7), (Color{0, 0, 0}));
  EXPECT_EQ(mix({10, 10, 10}, {0, 0, 0}, std::numeric_limits<double>::quiet_NaN()),
            (Color{10, 10, 10}));
}

TEST(Color, TheRampDarkensAllTheWay) {
  for (int i = 0; i < 100; ++i) {
    EXPECT_GT(luminance(ramp_color(i / 100.0)), luminance(ramp_color((i + 1) / 100.0))) << i;
  }
}

TEST(Color, TextReadsOnEveryFill) {
  for (int i = 0; i <= 100; ++i) EXPECT_GE(contrast(kInk, ramp_color(i / 100.0)), 4.0) << i;
  for (std::size_t i = 0; i < kHueCount; ++i) EXPECT_GE(contrast(ink_on(hue(i)), hue(i)), 3.0) << i;
  EXPECT_GE(contrast(kQuiet, kWhite), 4.5);
}

TEST(Color, ADarkPageReadsAsWellAsALightOne) {
  const Color page = dark_twin(kWhite);
  EXPECT_LT(luminance(page), 0.02);
  // WCAG 2.1: 4.5 for text, 3 for the lines of a drawing.
  for (const Color text : {kInk, kQuiet, kLimit, kOurs}) {
    EXPECT_GE(contrast(dark_twin(text), page), 4.5) << to_hex(text);
  }
  for (const Color line : {kWall, kOursToo, kOther, kOtherToo, kDoor}) {
    EXPECT_GE(contrast(dark_twin(line), page), 3.0) << to_hex(line);
  }
  for (std::size_t i = 0; i < kHueCount; ++i) {
    EXPECT_GE(contrast(dark_twin(hue(i)), page), 3.0) << i;
    // Text on a block of colour is dark there.
    EXPECT_GE(contrast(page, dark_twin(hue(i))), 4.5) << i;
    // A zone's tint is a ground for text and lines.
    EXPECT_GE(contrast(dark_twin(kInk), dark_twin(mix(kWhite, hue(i), 0.2))), 7.0) << i;
  }
}

TEST(Color, OnADarkPageTheRampBrightensAllTheWay) {
  for (int i = 0; i < 20; ++i) {
    EXPECT_LT(luminance(dark_twin(ramp_color(i / 20.0))),
              luminance(dark_twin(ramp_color((i + 1) / 20.0))))
        << i;
    EXPECT_GE(contrast(dark_twin(kInk), dark_twin(ramp_color(i / 20.0))), 3.0) << i;
  }
}

TEST(Color, ADarkTwinKeepsItsHue) {
  // Grey stays grey; blue stays bluer than it is red.
  const Color grey = dark_twin({0x80, 0x80, 0x80}), blue = dark_twin(kOurs);
  EXPECT_LE(std::abs(grey.r - grey.b), 1);
  EXPECT_LE(std::abs(grey.r - grey.g), 1);
  EXPECT_GT(blue.b, blue.r + 60);
}

TEST(Color, HuesAreDifferent) {
  for (std::size_t i = 0; i < kHueCount; ++i) {
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(hue(i), hue(k));
  }
  EXPECT_EQ(hue(kHueCount), hue(0));
}

}  // namespace
}  // namespace zonepack::report
