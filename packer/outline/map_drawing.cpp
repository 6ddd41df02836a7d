// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/map_drawing.hpp"

#include <optional>

#include "packer/outline/occupancy_map.hpp"

namespace zonepack::packer {
namespace {

MapDrawing from_grids(MapSource& source) {
  MapDrawing plan;
  plan.source = "local grids";
  constexpr PayloadSet kGridOnly{.features = false,
                                 .scan = false,
                                 .grid = true,
                                 .image = false,
                                 .depth = false,
                                 .userdata = false};
  std::optional<OccupancyMap> map;
  SignatureRecord record;
  for (const NodeOutline& node : source.outline().nodes) {
    if (!node.pose || node.damaged) continue;
    try {
      source.read(node.id, kGridOnly, record);
    } catch (const DamagedSignature& damage) {
      plan.warnings.push_back(std::string(damage.what()) + "; its grid is left out");
      continue;
    }
    if (!record.grid || !(record.grid->cell_size > 0)) continue;
    if (!map) map.emplace(decimal_of(record.grid->cell_size));
    map->add(*record.grid, *node.pose);
    ++plan.grids;
  }
  if (map) plan.image = map->image();
  return plan;
}

}  // namespace

MapDrawing drawing_of(MapSource& source) {
  const std::optional<OptimisedMap>& own = source.outline().optimised_map;
  if (own && own->resolution > 0) return {image_of(*own), "the database's own map", 0, {}};
  return from_grids(source);
}

}  // namespace zonepack::packer
