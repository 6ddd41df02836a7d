// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "packer/outline/floor_heights.hpp"
#include "packer/outline/map_image.hpp"
#include "packer/outline/seen_places.hpp"
#include "packer/record/source_kind.hpp"

// A floor plan of a map that shows space and has no grids: a slice at the height of a robot.
namespace zonepack::packer {

// The cells between two heights above the floor. A cell with a surface between them is occupied,
// unless ten times as many points show its floor; one that shows the floor, or free space between
// the heights, is free; anything else is unknown. Gaps of up to 0.25 m between occupied cells in a
// row or column are closed, as no robot passes them, then those between free cells.
//
// Memory: 2 bytes a cell, of which there are at most kMostServedCells; where more would be needed
// around the floor, cells are twice as large, and so on up to 1 m.
class Slice {
 public:
  // The floor has at least one square. Throws NoFloorPlan when cells of 1 m are too many.
  Slice(FloorHeights floor, SliceHeights heights, double cell_m);

  void add(double x_m, double y_m, double z_m, Seen seen);

  // What was seen, with a margin of 0.5 m; without cells when nothing was.
  MapImage image() const;
  double cell_m() const noexcept { return cell_m_; }

 private:
  struct Counts {
    std::uint8_t clear = 0, blocked = 0;  // they stop at 255
  };
  struct Box {
    std::int64_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // cells from and to, the latter not in it
    std::int64_t width() const { return x1 - x0; }
    std::int64_t height() const { return y1 - y0; }
  };
  Box cells_around_floor() const;
  Box seen_box() const;
  std::size_t place_of(std::int64_t x, std::int64_t y) const;

  FloorHeights floor_;
  SliceHeights heights_;
  double cell_m_;
  Box box_;
  std::vector<Counts> counts_;
  FloorSquare last_square_;
  std::optional<double> last_z_m_;
  bool any_ = false;
};

}  // namespace zonepack::packer
