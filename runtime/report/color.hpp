// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>

namespace zonepack::report {

struct Color {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Color&, const Color&) = default;
  friend bool operator<(const Color& one, const Color& other) noexcept {
    return std::tie(one.r, one.g, one.b) < std::tie(other.r, other.g, other.b);
  }
};

// "#rrggbb".
std::string to_hex(Color color);

// weight 0: a; 1: b.
Color mix(Color a, Color b, double weight) noexcept;

// The same colour for a dark page: lightness turned around, hue kept; pale grounds become dark
// ones, ink becomes light. The colours of lines and blocks below that stand out on both stay as
// they are, and all that fill a block come out light enough for dark text.
Color dark_twin(Color color) noexcept;

// Black or white, whichever reads better on `background`.
Color ink_on(Color background) noexcept;

// From pale to deep for share 0 to 1. Darkness rises throughout, so that the ramp works in grey and
// for colour-blind readers; black text stays readable on all of it.
Color ramp_color(double share) noexcept;

// Colours that colour-blind readers can distinguish, too (after P. Tol's "muted" scheme); repeats
// after kHueCount.
inline constexpr std::size_t kHueCount = 9;
Color hue(std::size_t index) noexcept;

inline constexpr Color kWhite{255, 255, 255};
inline constexpr Color kInk{0x1f, 0x24, 0x2b};       // text
inline constexpr Color kQuiet{0x5c, 0x65, 0x70};     // secondary text
inline constexpr Color kFaint{0xe3, 0xe6, 0xea};     // grid lines
inline constexpr Color kWall{0x8a, 0x93, 0x9e};      // zone borders
inline constexpr Color kOurs{0x0b, 0x5f, 0xa5};      // what Zonepack does
inline constexpr Color kOursToo{0x3b, 0xa7, 0x8f};   // its second curve
inline constexpr Color kOther{0x9a, 0x9a, 0x9a};     // what is compared with
inline constexpr Color kOtherToo{0xb8, 0xa0, 0x78};  // its second curve
inline constexpr Color kLimit{0xc4, 0x2b, 0x1c};     // limits, and what is wrong
inline constexpr Color kDoor{0xe0, 0x7b, 0x00};      // portals

}  // namespace zonepack::report
