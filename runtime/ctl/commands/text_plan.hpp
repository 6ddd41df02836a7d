// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/ctl/commands/screen_line.hpp"

namespace zonepack {

// The floor plan of a map in characters: north (y) is up, a character is twice as high as wide.
// Zones are shaded by their state and bear their names where there is room; an arrow is the robot.
//
// Threads: one. draw() remembers which zone each character shows, for the last size.
class TextPlan {
 public:
  struct Point {
    double x_m = 0, y_m = 0;
  };
  using Outline = std::vector<Point>;

  enum class Look : std::uint8_t { kAbsent, kWanted, kFilling, kResident, kOwn };
  struct Shade {
    std::string name;
    const char* style = nullptr;  // an ANSI escape
    Look look = Look::kAbsent;
  };
  struct Robot {
    double x_m = 0, y_m = 0, yaw_rad = 0;
  };
  struct Size {
    int columns = 0, rows = 0;
  };

  TextPlan() = default;
  // One outline a zone. utf8: the terminal shows more than ASCII.
  TextPlan(std::vector<Outline> zones, bool utf8);

  bool empty() const noexcept { return zones_.empty(); }

  // How many columns the plan takes in so many rows, if there are enough.
  int columns_in(int rows) const noexcept;

  // Rows of the plan, no wider than the size and no more than its rows; without line ends. shades:
  // of each zone; zones without one are not drawn.
  std::vector<ScreenLine> draw(Size size, const std::vector<Shade>& shades,
                               const std::optional<Robot>& robot, bool color) const;

 private:
  static constexpr std::size_t kNothing = ~std::size_t{0};
  struct Raster {
    Size size;
    double column_m = 1;               // width of a character; its height is twice that
    int columns = 0, rows = 0;         // that the map takes
    std::vector<std::size_t> zone_at;  // row by row from the top; kNothing: outside
  };

  void rasterise(Size size) const;
  std::size_t zone_of(Point p) const noexcept;
  std::size_t at(int column, int row) const noexcept;
  const char* glyph_of(Look look) const noexcept;
  const char* arrow_of(double yaw_rad) const noexcept;

  std::vector<Outline> zones_;
  std::vector<std::pair<Point, Point>> boxes_;  // lowest and highest corner of each
  Point low_, high_;                            // of all
  bool utf8_ = false;
  mutable Raster raster_;
};

// Whether the environment (LC_ALL, LC_CTYPE, LANG) says that the terminal shows UTF-8.
bool terminal_shows_utf8();
// Whether colours are wanted: not with NO_COLOR, nor on a dumb terminal.
bool terminal_shows_color();

}  // namespace zonepack
