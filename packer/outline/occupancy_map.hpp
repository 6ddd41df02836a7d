// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "packer/outline/map_image.hpp"
#include "packer/record/record.hpp"

// An occupancy grid assembled from the local grids of the signatures.
namespace zonepack::packer {

// Adds up local grids. A cell seen as empty or ground counts as a vote for free, one with an
// obstacle as a vote for occupied; the sum decides, with RTAB-Map's own weights (hit 0.7, miss 0.4,
// limits 0.12 and 0.97, occupied from 0.5). Free cells are looked up from the map's cells, so that
// a rotated grid leaves no pinholes.
//
// Memory: grows with the area seen, not with its extent.
class OccupancyMap {
 public:
  explicit OccupancyMap(double resolution_m);

  // `grid` in the base frame, `T_map_base` optimised. Skips cells that are not numbers or are more
  // than 100 m from the robot.
  void add(const Grid& grid, const Transform& T_map_base);

  // The area seen, with a margin of 0.5 m; empty when nothing was seen. Throws std::runtime_error
  // when it would have more than 2^29 cells: some signature is far off the map.
  MapImage image() const;

 private:
  static constexpr std::int64_t kTile = 64;
  static constexpr std::int16_t kUnseen = INT16_MIN;
  using Tile = std::array<std::int16_t, kTile * kTile>;
  struct Index {
    std::int64_t x = 0, y = 0;
    // clang-tidy takes the 0 that a defaulted <=> compares with for a pointer.
    // NOLINTNEXTLINE(modernize-use-nullptr)
    friend auto operator<=>(const Index&, const Index&) = default;
  };

  Index index_of(double x_m, double y_m) const;
  std::vector<Index> obstacles(const Matrix& cells, const Transform& T_map_base) const;
  void add_free(std::span<const std::pair<double, double>> p_base, double cell_m,
                const Transform& T_map_base, const std::vector<Index>& occupied);
  void vote(Index index, int evidence);

  const double resolution_m_;
  std::map<std::pair<std::int64_t, std::int64_t>, Tile> tiles_;
};

}  // namespace zonepack::packer
