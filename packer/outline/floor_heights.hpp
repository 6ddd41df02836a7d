// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <unordered_map>
#include <vector>

// Where the floor is, found in points on surfaces.
namespace zonepack::packer {

// Why no floor plan can be drawn of a map, and what to do.
class NoFloorPlan : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A square of 2 m by 2 m; its lower corner is at (2 x, 2 y).
struct FloorSquare {
  std::int32_t x = 0, y = 0;
  bool operator==(const FloorSquare&) const = default;
};

struct FloorSquareHash {
  std::size_t operator()(const FloorSquare& s) const noexcept {
    const auto bits = static_cast<std::uint64_t>(static_cast<std::uint32_t>(s.x)) << 32 |
                      static_cast<std::uint32_t>(s.y);
    return static_cast<std::size_t>((bits * 0x9E3779B97F4A7C15U) >> 20);
  }
};

inline constexpr double kFloorSquare_m = 2;

// The height of the floor in each square with points that has a floor, or is next to one that has.
struct FloorHeights {
  std::unordered_map<FloorSquare, double, FloorSquareHash> z_m;

  std::optional<double> at(const FloorSquare& square) const;
  double median_m() const;  // of at least one square
};

FloorSquare floor_square_of(double x_m, double y_m);

// Finds the floor as the lowest strong level: space is cut into levels of 0.1 m and places of 0.25
// m, and counted are places that a point of two levels covers, as most of the eight around them,
// with nothing in the two levels above. What covers ground like that is level and wide: a wall, a
// pole or the points of a scan in one plane do not. In the 6 m by 6 m around a square, the lowest
// level is taken that covers at least 2 m² and a quarter of what the largest covers, as a ceiling
// may. The square's own level, of at least 1 m², replaces it where the two are up to 0.2 m apart,
// so that the floor may slope; its height is the mean of the points.
//
// Memory: 56 bytes a level of a square in which points are, of which there are at most kMostLevels.
class FloorFinder {
 public:
  static constexpr std::size_t kMostLevels = std::size_t{1} << 21;

  // A point on a surface, within 10,000 km.
  void add(double x_m, double y_m, double z_m);

  // Nothing is held of the points afterwards. The order in which they came makes no difference.
  // Throws NoFloorPlan when they lie in more than kMostLevels, or show no floor.
  FloorHeights find();

 private:
  struct Key {
    FloorSquare square;
    std::int32_t level = 0;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const noexcept;
  };
  struct Level {
    std::uint64_t covered = 0;     // 8 x 8 places, x fastest
    std::uint64_t height_sum = 0;  // of points above the level's lower side, in 1/1024 of a level
    std::uint32_t points = 0;
  };
  // What is level and wide in a square, over two levels.
  struct Flat {
    std::int32_t level = 0;
    std::uint32_t places = 0;
    double z_sum_m = 0, points = 0;
  };
  using Flats = std::unordered_map<FloorSquare, std::vector<Flat>, FloorSquareHash>;

  const Level* level(const Key& key) const;
  std::uint64_t covered(const Key& key) const;
  std::uint32_t wide_places(const Key& key) const;
  Flats flats() const;
  static std::optional<Flat> around(const Flats& flats, const FloorSquare& square);

  std::unordered_map<Key, Level, KeyHash> levels_;
  Key last_key_;
  Level* last_ = nullptr;
};

}  // namespace zonepack::packer
