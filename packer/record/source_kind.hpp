// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "packer/record/map_source.hpp"

namespace zonepack::packer {

// Where a map stands that was made in a frame of its own: without level or, with one camera, scale.
struct FramePlacement {
  // A trajectory (TUM: stamp x y z qx qy qz qw) of the robot's base in the frame wanted.
  std::filesystem::path trajectory;
  std::optional<double> metres_per_unit;
  std::optional<std::array<double, 3>> up;  // in the source's frame, any length; none: found
  // x, y, z in metres, then roll, pitch, yaw in degrees, of a camera that at zero looks along the
  // base's x axis. None: at the base, turned as the trajectory shows or looking along x.
  std::optional<std::array<double, 6>> camera_in_base;

  // The option that gave the first of these; empty: none is given.
  std::string first_option() const {
    return !trajectory.empty() ? "--align"
           : metres_per_unit   ? "--scale"
           : up                ? "--up"
           : camera_in_base    ? "--camera-in-base"
                               : "";
  }
};

// Options that do not fit the source: a wrong command line, as only the source can show.
class SourceUsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Above the floor, metres: what stands between is in the way of a robot.
struct SliceHeights {
  double low_m = 0.2, high_m = 1.5;
};

// How a source is opened. All commands share these options.
struct SourceOptions {
  SourceOptions() = default;
  SourceOptions(std::filesystem::path where) : path(std::move(where)) {}

  std::string name() const { return path.string(); }

  std::filesystem::path path;
  std::string kind;  // SourceKind::name; empty: found by content
  FramePlacement placement;
  double tile_m = 10;  // the side of a tile, where a cloud is cut into tiles
  SliceHeights slice;  // for a floor plan, where the map has no grids
  // The zone at a place of the map, or any number for none: clouds are cut where it changes. Empty:
  // there are no zones.
  std::function<std::uint32_t(double x_m, double y_m, double z_m)> zone_at;
};

// One kind of map that can be packed.
struct SourceKind {
  const char* name;  // of --from, and of the manifest's source_kind
  const char* what;  // "an RTAB-Map database"
  // Whether a file or folder is of this kind, by its content. Throws nothing: what cannot be read
  // is of no kind.
  bool (*recognises)(const std::filesystem::path& path);
  std::unique_ptr<MapSource> (*open)(const SourceOptions& options);
  bool takes_placement = false;  // its maps have a frame of their own (FramePlacement)
};

}  // namespace zonepack::packer
