// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/suggest_ground.hpp"

#include <cmath>
#include <memory>
#include <stdexcept>

#include "packer/commands/report.hpp"
#include "packer/outline/map_server.hpp"
#include "packer/sources/open_source.hpp"

namespace zonepack::packer {

using suggest::FreeSpace;
using suggest::GridPlace;
using suggest::PathPlace;

namespace {

constexpr double kMostGap_m = 10;  // along a path; farther apart are two signatures of two paths

void read_signatures(const MapOutline& outline, SuggestGround& ground) {
  for (const NodeOutline& node : outline.nodes) {
    if (!node.pose) continue;
    const Transform& T = *node.pose;
    ground.places.push_back({node.id, {T[3], T[7]}, T[11]});
    ground.sessions.push_back(node.map_id);
  }
}

}  // namespace

SuggestGround read_ground(const std::optional<SourceOptions>& from, const std::string& grid) {
  SuggestGround ground;
  if (!grid.empty()) {
    ground.drawing = drawing_of(read_grid_file(grid));
  }
  if (from) {
    const std::unique_ptr<MapSource> source = open_source(*from);
    require_signatures(source->outline(), from->name());
    if (grid.empty()) ground.drawing = drawing_of(*source, from->slice);
    if (ground.drawing.image.cells.empty()) {
      throw std::runtime_error(
          from->name() + ": " + ground.drawing.missing +
          "; there is no floor plan to draw zones on: add a grid in the same frame with --grid "
          "map.yaml");
    }
    read_signatures(source->outline(), ground);
    source->require_unchanged();
  }
  return ground;
}

FreeSpace free_space_of(const MapImage& image) {
  if (image.width == 0 || image.height == 0 || image.width > kMostServedCells / image.height) {
    throw std::runtime_error("the floor plan has " + std::to_string(image.width) + " x " +
                             std::to_string(image.height) + " cells, at most " +
                             std::to_string(kMostServedCells) + " are searched for rooms");
  }
  FreeSpace space;
  space.columns = static_cast<std::int32_t>(image.width) + 2;
  space.rows = static_cast<std::int32_t>(image.height) + 2;
  space.cell_m = image.resolution_m;
  space.free.resize(static_cast<std::size_t>(space.columns) * static_cast<std::size_t>(space.rows));
  for (std::size_t row = 0; row < image.height; ++row) {
    for (std::size_t column = 0; column < image.width; ++column) {
      const auto to = (row + 1) * static_cast<std::size_t>(space.columns) + column + 1;
      space.free[to] = image.at(column, row) == Cell::kFree ? 1 : 0;
    }
  }
  return space;
}

GridPlace place_of(const SuggestGround& ground) {
  const MapImage& image = ground.drawing.image;
  GridPlace place;
  if (ground.drawing.yaw_rad != 0) {
    place.cos = std::cos(ground.drawing.yaw_rad);
    place.sin = std::sin(ground.drawing.yaw_rad);
  }
  const double cell = image.resolution_m;  // of the margin
  place.corner = {image.x_min_m - (place.cos * cell - place.sin * cell),
                  image.y_min_m - (place.sin * cell + place.cos * cell)};
  return place;
}

std::vector<PathPlace> path_of(const SuggestGround& ground, const FreeSpace& space,
                               const GridPlace& place, const PathRule& rule) {
  std::vector<PathPlace> path;
  std::int32_t stretch = 0;
  double metres = 0, count = 0;
  for (std::size_t i = 0; i < ground.places.size(); ++i) {
    const Point2 p = ground.places[i].p_map;
    const double step = i == 0 ? 0 : distance_m(p, ground.places[i - 1].p_map);
    const bool jump = i > 0 && (ground.sessions[i] != ground.sessions[i - 1] || step > kMostGap_m);
    if (!jump) metres += step;
    if (jump || (rule.by == PathRule::kMetres ? metres >= rule.size : count >= rule.size)) {
      ++stretch;
      metres = count = 0;
    }
    ++count;
    const double dx = p.x_m - place.corner.x_m, dy = p.y_m - place.corner.y_m;
    const double column = std::floor((place.cos * dx + place.sin * dy) / space.cell_m);
    const double row = std::floor((place.cos * dy - place.sin * dx) / space.cell_m);
    if (!(column >= 1 && row >= 1 && column < space.columns - 1 && row < space.rows - 1)) continue;
    path.push_back(
        {space.at(static_cast<std::int32_t>(column), static_cast<std::int32_t>(row)), stretch});
  }
  return path;
}

}  // namespace zonepack::packer
