// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/map_drawing.hpp"

#include <cstdio>
#include <optional>
#include <set>
#include <utility>

#include "packer/outline/floor_heights.hpp"
#include "packer/outline/occupancy_map.hpp"
#include "packer/outline/seen_places.hpp"
#include "packer/outline/slice.hpp"

namespace zonepack::packer {
namespace {

constexpr PayloadSet kGridOnly{.features = false,
                               .scan = false,
                               .grid = true,
                               .image = false,
                               .depth = false,
                               .userdata = false,
                               .blocks = false};

std::string metres_text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  return buffer;
}

void draw_grids(const EachSignature& each, MapDrawing& plan) {
  plan.source = "local grids";
  std::optional<OccupancyMap> map;
  each(kGridOnly, [&](const SignatureRecord& record) {
    if (!record.pose || !record.grid || !(record.grid->cell_size > 0)) return;
    if (!map) map.emplace(decimal_of(record.grid->cell_size));
    map->add(*record.grid, *record.pose);
    ++plan.grids;
  });
  if (map) plan.image = map->image();
}

// The side of a cell, as the first signature that shows places has it; 0: none does.
double see_places(const EachSignature& each, const SeenPlace& place) {
  double cell_m = 0;
  each(kPlacesOnly, [&](const SignatureRecord& record) {
    if (cell_m == 0) cell_m = cell_size_of(record);
    for_each_place(record, place);
  });
  return cell_m;
}

// Throws NoFloorPlan.
void draw_slice(const EachSignature& each, const SliceHeights& heights, MapDrawing& plan) {
  FloorFinder finder;
  const double cell_m = see_places(each, [&finder](double x, double y, double z, Seen seen) {
    if (seen == Seen::kSurface) finder.add(x, y, z);
  });
  if (cell_m == 0) {
    throw NoFloorPlan(
        "no map of its own, no local grids, and no points or voxels to slice at a robot's height");
  }
  FloorHeights floor = finder.find();
  plan.source = "a slice";
  plan.detail = metres_text(heights.low_m) + " to " + metres_text(heights.high_m) +
                " m above the floor at z " + metres_text(floor.median_m());
  Slice slice(std::move(floor), heights, cell_m);
  see_places(each, [&slice](double x, double y, double z, Seen seen) { slice.add(x, y, z, seen); });
  plan.image = slice.image();
  if (slice.cell_m() > cell_m) {
    plan.warnings.push_back("the floor is so large that its plan has cells of " +
                            metres_text(slice.cell_m()) + " m instead of " + metres_text(cell_m) +
                            "; cut the map for a finer one");
  }
}

}  // namespace

void MapDrawing::warn_if_missing(const std::string& map) {
  if (!missing.empty()) warnings.push_back(map + ": " + missing + "; no occupancy grid is drawn");
}

MapDrawing drawing_of(const EachSignature& each, const SliceHeights& slice) {
  MapDrawing plan;
  draw_grids(each, plan);
  if (plan.grids > 0) return plan;
  try {
    draw_slice(each, slice, plan);
  } catch (const NoFloorPlan& reason) {
    plan.missing = reason.what();
  }
  return plan;
}

MapDrawing drawing_of(MapSource& source, const SliceHeights& slice) {
  const std::optional<OptimisedMap>& own = source.outline().optimised_map;
  if (own && own->resolution > 0)
    return {image_of(*own), "the database's own map", {}, 0, {}, {}, 0};
  std::set<std::string> damages;
  SignatureRecord record;
  const EachSignature each = [&](const PayloadSet& wanted, const SeeSignature& see) {
    for (const NodeOutline& node : source.outline().nodes) {
      if (!node.pose || node.damaged) continue;
      try {
        source.read(node.id, wanted, record);
      } catch (const DamagedSignature& damage) {
        damages.insert(std::string(damage.what()) + "; it is left out of the floor plan");
        continue;
      }
      see(record);
    }
  };
  MapDrawing plan = drawing_of(each, slice);
  plan.warnings.insert(plan.warnings.begin(), damages.begin(), damages.end());
  return plan;
}

}  // namespace zonepack::packer
