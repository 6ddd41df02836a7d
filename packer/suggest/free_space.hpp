// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

// Where a robot can stand, cell by cell. Cells are counted from 0, row by row, row 0 at the lowest
// y; the outermost rows and columns are never free, so that every free cell has eight neighbours.
namespace zonepack::packer::suggest {

// An index into the cells of a FreeSpace. Grids have at most 2^29 cells.
using CellIndex = std::int32_t;

struct FreeSpace {
  std::int32_t columns = 0, rows = 0;
  double cell_m = 0;
  std::vector<std::uint8_t> free;  // 1: free; 0: occupied or unknown

  CellIndex at(std::int32_t column, std::int32_t row) const noexcept {
    return row * columns + column;
  }
  std::size_t size() const noexcept { return free.size(); }
  bool is_free(CellIndex cell) const noexcept { return free[static_cast<std::size_t>(cell)] != 0; }
  double area_m2(std::size_t cells) const noexcept {
    return static_cast<double>(cells) * cell_m * cell_m;
  }
};

// Frees what is no wall: islands of cells that are not free (joined by edges or corners), smaller
// than `most_m2`. Long thin islands stay, because they are walls between doors, also where several
// walls meet in one.
void remove_clutter(FreeSpace& space, double most_m2);

// Of each cell, the squared distance in cells from its centre to that of the nearest cell that is
// not free; 0 where it is not free itself. Exact, in integers (Meijster, Roerdink and Hesselink, "A
// general algorithm for computing distance transforms in linear time", 2000).
std::vector<std::int32_t> squared_clearance(const FreeSpace& space);

}  // namespace zonepack::packer::suggest
