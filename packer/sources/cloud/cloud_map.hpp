// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "packer/record/record.hpp"
#include "packer/sources/cloud/point_stream.hpp"

namespace zonepack::packer {

// A piece of a cloud that becomes a signature.
struct CloudTile {
  std::int32_t id = 0;
  std::string label;  // the file or submap; empty for a tile cut from a file
  double stamp_s = 0;
  std::uint64_t points = 0;
  std::array<double, 3> base{};  // a point of the tile, so that it lies in the tile's zone
  Transform T_map_base{};
  Transform T_base_points{};  // from the frame in which points are stored
};

// The points of a tile, column by column, as they are packed.
struct TilePoints {
  std::vector<float> x, y, z, intensity, ring;
  std::vector<std::uint32_t> rgb;
  void clear();
  std::size_t size() const noexcept { return x.size(); }
};

// A cloud cut into tiles. Reading is const and may be done by several threads.
class CloudMap {
 public:
  virtual ~CloudMap() = default;
  virtual void read(const CloudTile& tile, TilePoints& into) const = 0;
  virtual void require_unchanged() const = 0;

  std::string version;  // "pcd binary", "autoware", "glim"
  CloudFields fields;
  std::vector<CloudTile> tiles;  // ascending id, from 1
  std::uint64_t points = 0, source_bytes = 0;
  std::vector<std::string> warnings, notes;
};

// The points of one file into one tile, those that are not finite left out. `origin` is subtracted
// from float64 coordinates before they are rounded to float32.
void read_points(PointStream& stream, const std::array<double, 3>& origin, TilePoints& into);

// Whether a point can be on a map: finite, and within 10,000 km.
bool is_place(const CloudPoint& point);

// Orders points in blocks of 32 neighbours (kBlockRows), for columns keep what is common to a block
// once: a k-d tree over the bits of the coordinates, where numbers near zero lie as far apart as in
// a float.
void sort_in_blocks(TilePoints& points);

}  // namespace zonepack::packer
