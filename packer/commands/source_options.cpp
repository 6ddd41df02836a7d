// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/source_options.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "packer/sources/open_source.hpp"

namespace zonepack::packer {
namespace {

constexpr const char* kPlacing =
    "Maps of keyframes (stella_vslam), which have a frame of their own";

// Exactly N finite numbers, separated by commas.
template <std::size_t N>
std::array<double, N> numbers_of(const std::string& option, const std::string& text,
                                 const char* expected) {
  std::array<double, N> numbers{};
  std::size_t at = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const std::size_t end = i + 1 < N ? text.find(',', at) : text.size();
    const bool found =
        end != text.npos && CLI::detail::lexical_cast(text.substr(at, end - at), numbers[i]);
    if (!found || !std::isfinite(numbers[i])) {
      throw CLI::ValidationError(option, "'" + text + "' is not " + expected);
    }
    at = end + 1;
  }
  return numbers;
}

}  // namespace

CLI::Option* add_source_options(CLI::App& command, SourceOptions& source, const std::string& what) {
  std::string kinds, names;
  for (const SourceKind* kind : source_kinds()) {
    names += (names.empty() ? "" : ", ") + std::string(kind->name);
    kinds += (kinds.empty() ? "" : ", ") + std::string(kind->what);
  }
  CLI::Option* const db =
      command.add_option("--db", source.path, what + ": " + kinds + "; only read")
          ->type_name("PATH");
  command
      .add_option_function<std::string>(
          "--from",
          [&source, names](const std::string& text) {
            const auto known = source_kinds();
            if (std::ranges::find(known, text, &SourceKind::name) == known.end()) {
              throw CLI::ValidationError("--from", "'" + text + "' is none of " + names);
            }
            source.kind = text;
          },
          "what --db is, instead of what its content shows: " + names)
      ->type_name("KIND");
  command
      .add_option_function<double>(
          "--tile",
          [&source](double metres) {
            if (!(metres >= 0.1 && metres <= 10000)) {
              throw CLI::ValidationError("--tile", "expected 0.1 to 10000 metres");
            }
            source.tile_m = metres;
          },
          "side of the tiles that a point cloud (*.pcd) is cut into, also at zone borders; default "
          "10")
      ->type_name("METRES");
  FramePlacement& placement = source.placement;
  CLI::Option* const align =
      command
          .add_option(
              "--align", placement.trajectory,
              "trajectory of the robot's base in the frame wanted (TUM: stamp x y z qx qy qz "
              "qw): gives place, level and scale")
          ->type_name("FILE")
          ->group(kPlacing);
  command
      .add_option_function<double>(
          "--scale",
          [&placement](double metres) {
            if (!(metres > 0) || !std::isfinite(metres)) {
              throw CLI::ValidationError("--scale", "expected metres above 0");
            }
            placement.metres_per_unit = metres;
          },
          "metres of one unit of the map")
      ->type_name("METRES")
      ->excludes(align)
      ->group(kPlacing);
  command
      .add_option_function<std::string>(
          "--up",
          [&placement](const std::string& text) {
            if (text == "auto") return;
            const auto up = numbers_of<3>("--up", text, "x,y,z or auto, such as 0,-1,0");
            if (up[0] == 0 && up[1] == 0 && up[2] == 0) {
              throw CLI::ValidationError("--up", "'" + text + "' has no direction");
            }
            placement.up = up;
          },
          "where up is in the map's frame; auto (default): across the plane of the keyframes")
      ->type_name("X,Y,Z|auto")
      ->excludes(align)
      ->group(kPlacing);
  command
      .add_option_function<std::string>(
          "--camera-in-base",
          [&placement](const std::string& text) {
            placement.camera_in_base = numbers_of<6>(
                "--camera-in-base", text, "x,y,z,roll,pitch,yaw, such as 0.1,0,0.4,0,0,0");
          },
          "place of the camera on the robot: metres forward, left and up, then degrees; without "
          "rotation it looks forward. Default: in the base, turned as --align shows, or forward")
      ->type_name("X,Y,Z,ROLL,PITCH,YAW")
      ->group(kPlacing);
  return db;
}

void add_slice_option(CLI::App& command, SourceOptions& source) {
  command
      .add_option_function<std::string>(
          "--slice",
          [&source](const std::string& text) {
            const char* const expected =
                "LOW,HIGH: metres above the floor, from 0.05 to 10, such as 0.2,1.5";
            const auto [low, high] = numbers_of<2>("--slice", text, expected);
            if (!(low >= 0.05 && low < high && high <= 10)) {
              throw CLI::ValidationError("--slice", "'" + text + "' is not " + expected);
            }
            source.slice = {low, high};
          },
          "what is in a robot's way, metres above the floor, where a map has points or voxels and "
          "no grids; default 0.2,1.5")
      ->type_name("LOW,HIGH");
}

}  // namespace zonepack::packer
