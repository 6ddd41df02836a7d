// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/suggest.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "packer/suggest/arms.hpp"
#include "packer/suggest/basins.hpp"
#include "packer/suggest/borders.hpp"
#include "packer/suggest/cracks.hpp"
#include "packer/suggest/doors.hpp"
#include "packer/suggest/islets.hpp"
#include "packer/suggest/kinds.hpp"
#include "packer/suggest/passes.hpp"
#include "packer/zones/findings.hpp"
#include "packer/zones/geojson.hpp"
#include "runtime/pack_format/limits.hpp"

namespace zonepack::packer::suggest {
namespace {

// Free-standing furniture, a table with its chairs. Half a square metre leaves tables that cut
// rooms in two, four free what a robot did not see between walls (both measured).
constexpr double kClutter_m2 = 2.5;
// A smaller closed room is a corner behind furniture; one that is nowhere wider, the inside of a
// wall.
constexpr Islets kIslets{.least_m2 = 4, .least_width_m = 0.6};
constexpr double kBridge_m = 1;  // from a corner behind furniture to its room
constexpr double kLooseRatio = 0.6;
constexpr double kDoorReach_m = 0.5;
constexpr double kGap_m2 = 2;  // a pillar this small needs no hole
constexpr double kLeastPortal_m = 0.3;
constexpr std::int32_t kMostPieces = 1 << 19;
constexpr const char* kExpected =
    "expected a floor plan, not noise: smooth it, cut it, or give its cells a coarser resolution";

// Before each piece gets tables of its own.
void require_few_pieces(const Regions& regions) {
  if (regions.count <= kMostPieces) return;
  throw std::runtime_error("its free ground falls into " + std::to_string(regions.count) +
                           " pieces, at most " + std::to_string(kMostPieces) +
                           " are searched for rooms; " + kExpected);
}

// Before they are written as a drawing that nobody could read again.
void require_fits_a_file(const ZonePlan& plan) {
  constexpr std::size_t kValuesOfFeature = 20, kValuesOfCorner = 3;  // in GeoJSON
  std::size_t corners = 0;
  for (const PlannedZone& zone : plan.zones) {
    corners += zone.polygon.outer.size();
    for (const Ring& hole : zone.polygon.holes) corners += hole.size();
  }
  if (kValuesOfFeature * (plan.zones.size() + plan.portals.size()) + kValuesOfCorner * corners <=
      kMaxJsonValues) {
    return;
  }
  throw std::runtime_error("its zones have " + std::to_string(corners) + " corners and " +
                           std::to_string(plan.portals.size()) +
                           " portals, more than a zone file may hold; " + kExpected);
}

// Regions as zones with names; `whole` are the regions before long ones were cut.
class Drawer {
 public:
  Drawer(const FreeSpace& space, const GridPlace& place, const Regions& whole, Suggestion& result)
      : space_(space), place_(place), whole_(whole), result_(result) {}

  void run(const std::vector<std::int32_t>& clearance2) {
    const Regions& regions = result_.regions;
    name_zones(clearance2);
    const std::vector<Border> traced = trace_borders(regions, space_);
    std::vector<Border> borders;
    borders.reserve(traced.size());
    for (const Border& border : traced) borders.push_back(simplified(border));
    const auto rings = rings_of(borders, regions.count);
    for (std::size_t i = 0; i < rings.size(); ++i) draw(rings[i], result_.plan.zones[i]);
    for (std::size_t i = 0; i < traced.size(); ++i) add_doors(traced[i], borders[i]);
    name_portals();
    require_fits_a_file(result_.plan);
    const std::vector<std::uint32_t> zone_of = sort_by_name(result_.plan);
    for (Region& region : result_.regions.of_cell) {
      if (region != kNoRegion) {
        region = static_cast<Region>(zone_of[static_cast<std::size_t>(region)]);
      }
    }
  }

 private:
  void name_zones(const std::vector<std::int32_t>& clearance2) {
    const Regions& regions = result_.regions;
    const std::vector<Kind> kinds = kinds_of(whole_, space_, clearance2);
    const std::vector<std::string> names = names_of(kinds);
    std::vector<std::map<Region, std::size_t>> share(static_cast<std::size_t>(regions.count));
    for (std::size_t i = 0; i < space_.size(); ++i) {
      if (regions.of_cell[i] != kNoRegion && whole_.of_cell[i] != kNoRegion) {
        ++share[static_cast<std::size_t>(regions.of_cell[i])][whole_.of_cell[i]];
      }
    }
    std::vector<std::vector<std::size_t>> parts(names.size());
    std::vector<std::size_t> home(share.size());
    for (std::size_t i = 0; i < share.size(); ++i) {
      const auto most =
          std::max_element(share[i].begin(), share[i].end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
      home[i] = static_cast<std::size_t>(most->first);
      parts[home[i]].push_back(i);
    }
    const std::vector<std::size_t> cells = cells_of_each(regions);
    result_.plan.zones.resize(share.size());
    for (std::size_t whole = 0; whole < parts.size(); ++whole) {
      for (std::size_t k = 0; k < parts[whole].size(); ++k) {
        PlannedZone& zone = result_.plan.zones[parts[whole][k]];
        zone.name = names[whole];
        if (parts[whole].size() > 1) zone.name += "." + std::to_string(k + 1);
        zone.zone_type = kinds[whole].name;
        zone.label = area_text(space_.area_m2(cells[parts[whole][k]]));
      }
    }
  }

  static std::string area_text(double area_m2) {
    const auto tenths = static_cast<std::int64_t>(area_m2 * 10 + 0.5);
    return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " m2";
  }

  Point2 point(Corner corner) const {
    const double x = corner.x * space_.cell_m, y = corner.y * space_.cell_m;
    // Whole tenths of a millimetre: what is left of sin and cos is the same everywhere.
    const auto round = [](double v) { return std::floor(v * 1e4 + 0.5) / 1e4; };
    return {round(place_.corner.x_m + place_.cos * x - place_.sin * y),
            round(place_.corner.y_m + place_.sin * x + place_.cos * y)};
  }

  void draw(const std::vector<std::vector<Corner>>& rings, PlannedZone& zone) const {
    std::size_t vertices = 0;
    for (std::size_t i = 0; i < rings.size(); ++i) {
      Ring ring;
      for (const Corner corner : rings[i]) ring.push_back(point(corner));
      vertices += ring.size();
      (i == 0 ? zone.polygon.outer : zone.polygon.holes.emplace_back()) = std::move(ring);
    }
    if (vertices > kMaxVerticesPerZone) {
      throw std::runtime_error(
          "zone '" + zone.name + "' near " + point_text(zone.polygon.outer[0]) + " would have " +
          std::to_string(vertices) + " vertices, at most " + std::to_string(kMaxVerticesPerZone) +
          " are allowed: cut long zones with --max-length");
    }
  }

  // A portal on every stretch of a border where both sides are free.
  void add_doors(const Border& traced, const Border& border) {
    if (!traced.between_regions()) return;
    for (const Opening& opening : openings_of(traced, space_)) {
      const Segment2 segment =
          width2_of(opening, traced)
              ? Segment2{point(traced.corners[opening.from]), point(traced.corners[opening.to])}
              : longest_of(border);
      doors_.push_back({traced.left, traced.right, segment});
    }
  }

  // Of a border all around: its longest straight stretch.
  Segment2 longest_of(const Border& border) const {
    Segment2 longest{point(border.corners[0]), point(border.corners[1])};
    for (std::size_t i = 1; i + 1 < border.corners.size(); ++i) {
      const Segment2 next{point(border.corners[i]), point(border.corners[i + 1])};
      if (distance_m(longest.p, longest.q) < distance_m(next.p, next.q)) longest = next;
    }
    return longest;
  }

  // Of each pair: all wide doors, or the widest of the narrow ones.
  void name_portals() {
    std::map<std::pair<Region, Region>, std::vector<Segment2>> pairs;
    for (const Door& door : doors_) {
      pairs[std::minmax(door.a, door.b)].push_back(door.segment);
    }
    std::set<std::string> taken;
    for (auto& [pair, segments] : pairs) {
      std::stable_sort(segments.begin(), segments.end(), [](const Segment2& s, const Segment2& t) {
        return distance_m(s.p, s.q) > distance_m(t.p, t.q);
      });
      for (std::size_t i = 0; i < segments.size(); ++i) {
        if (i > 0 && distance_m(segments[i].p, segments[i].q) < kLeastPortal_m) break;
        auto a = static_cast<std::uint32_t>(pair.first),
             b = static_cast<std::uint32_t>(pair.second);
        if (result_.plan.zones[b].name < result_.plan.zones[a].name) std::swap(a, b);
        std::string name =
            fresh_portal_name(result_.plan.zones[a].name, result_.plan.zones[b].name, taken);
        result_.plan.portals.push_back({std::move(name), a, b, segments[i]});
      }
    }
    const std::vector<std::size_t> portals = portals_per_zone(result_.plan);
    for (std::size_t i = 0; i < portals.size(); ++i) {
      if (portals[i] == 0 && portals.size() > 1)
        result_.apart.push_back(result_.plan.zones[i].name);
    }
  }

  struct Door {
    Region a, b;
    Segment2 segment;
  };
  const FreeSpace& space_;
  const GridPlace& place_;
  const Regions& whole_;
  Suggestion& result_;
  std::vector<Door> doors_;
};

Regions regions_of(FreeSpace& space, const Options& options) {
  switch (options.method) {
    case Method::kGrid:
      return squares_of(space, options.square_m);
    case Method::kPath: {
      remove_clutter(space, kClutter_m2);
      Regions regions = stretches_of(space, options.path);
      require_few_pieces(regions);
      fold_small(regions, space, squared_clearance(space), options.min_area_m2, {});
      return regions;
    }
    case Method::kBasins:
      break;
  }
  return rooms_of(space, options);
}

}  // namespace

Regions rooms_of(FreeSpace& space, const Options& options) {
  remove_clutter(space, kClutter_m2);
  const std::vector<std::int32_t> clearance2 = squared_clearance(space);
  Regions regions = basins_of(space, clearance2, options.door_ratio);
  require_few_pieces(regions);
  fold_small(regions, space, clearance2, options.min_area_m2, kIslets);
  straighten_doors(regions, space, kDoorReach_m);
  renumber(regions, space);
  join_without_door(regions, space, clearance2, std::min(kLooseRatio, options.door_ratio));
  cut_arms(regions, space, clearance2);
  straighten_doors(regions, space, kDoorReach_m);
  renumber(regions, space);
  fold_small(regions, space, clearance2, options.min_area_m2, kIslets);
  fold_islets(regions, space, kBridge_m);
  return regions;
}

Suggestion suggest(FreeSpace space, const GridPlace& place, const Options& options) {
  Suggestion result;
  Regions whole = regions_of(space, options);
  require_few_pieces(whole);
  if (whole.count == 0) {
    throw std::runtime_error("no room was found: no free ground of " +
                             number_text(options.min_area_m2) +
                             " m2 or more; lower --min-area, or look at the grid's resolution");
  }
  const std::vector<std::int32_t> clearance2 = squared_clearance(space);
  result.regions = whole;
  if (options.max_length_m > 0) {
    cut_long(result.regions, space, options.max_length_m);
    require_few_pieces(result.regions);
    fold_small(result.regions, space, clearance2, options.min_area_m2, {});
    straighten_doors(result.regions, space, kDoorReach_m);
    renumber(result.regions, space);
    fold_small(result.regions, space, clearance2, options.min_area_m2, {});
  }
  if (part_at_cracks(result.regions, space, kLeastPortal_m)) {
    renumber(result.regions, space);
    fold_small(result.regions, space, clearance2, options.min_area_m2, {});
  }
  for (std::size_t i = 0; i < space.size(); ++i) {
    if (space.free[i] != 0 && result.regions.of_cell[i] == kNoRegion) ++result.dropped_cells;
  }
  fill_gaps(result.regions, space, kGap_m2);
  open_corners(result.regions, space);
  renumber(result.regions, space);
  Drawer(space, place, whole, result).run(clearance2);
  return result;
}

}  // namespace zonepack::packer::suggest
