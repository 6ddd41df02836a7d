// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/zone_checks.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "packer/zones/near_boxes.hpp"
#include "packer/zones/plane.hpp"
#include "packer/zones/zone_file.hpp"
#include "runtime/pack_format/limits.hpp"

namespace zonepack::packer {
namespace {

constexpr double kMaxDegreesExtent = 0.1;  // no building measures 10 cm
constexpr double kFlat_m = 1e-6;
constexpr std::size_t kMostPointsDrawn = 100;    // of one fault
constexpr std::size_t kMostOutlineFaults = 100;  // of one outline

std::string edge_text(const Ring& ring, std::size_t i) {
  return "edge " + std::to_string(i) + " " + point_text(ring[i]) + "-" +
         point_text(ring[(i + 1) % ring.size()]);
}

bool is_flat(const Ring& ring) noexcept {
  Point2 far = ring[0];
  for (const Point2 p : ring) {
    if (distance_m(ring[0], p) > distance_m(ring[0], far)) far = p;
  }
  Point2 near = ring[0];
  for (const Point2 p : ring) {
    if (distance_m(far, p) > distance_m(far, near)) near = p;
  }
  return std::all_of(ring.begin(), ring.end(), [&](Point2 p) {
    return distance_m(Segment2{near, far}, p) <= kFlat_m;
  });
}

// Adds what is wrong with one ring; true when it is sound.
bool check_ring(const Ring& ring, const std::string& what, std::vector<OutlineFault>& faults) {
  if (is_flat(ring)) {
    faults.push_back({"has no area: its " + what + " is a line; draw around the room"});
    return false;
  }
  const std::vector<SelfCrossing> crossings = self_crossings(ring);
  if (!crossings.empty()) {
    const SelfCrossing& c = crossings.front();
    std::string message = "crosses itself: in its " + what + ", " + edge_text(ring, c.edge_a) +
                          " meets " + edge_text(ring, c.edge_b) + " at " + point_text(c.at);
    if (crossings.size() > 1) {
      message += ", and " + std::string(crossings.size() == kMostSelfCrossings ? "over " : "") +
                 std::to_string(crossings.size() - 1) + " more such place" +
                 (crossings.size() > 2 ? "s" : "");
    }
    OutlineFault fault{message + "; put its vertices in order or delete the wrong one"};
    fault.place.areas.push_back(ring);
    for (const SelfCrossing& crossing : crossings) {
      if (fault.place.points.size() < kMostPointsDrawn) fault.place.points.push_back(crossing.at);
    }
    faults.push_back(std::move(fault));
    return false;
  }
  if (area_m2({ring, {}}) < kMinZoneArea_m2) {
    faults.push_back(
        {"has no area: its " + what + " encloses less than 1 cm2; are the coordinates in metres?"});
    return false;
  }
  return true;
}

void check_names(const Drawing& drawing, Findings& findings) {
  std::map<std::string, std::size_t> first;
  for (const DrawnZone& drawn : drawing.zones) {
    if (drawn.zone.name.empty()) continue;
    const auto [it, fresh] = first.emplace(drawn.zone.name, drawn.feature);
    if (fresh) continue;
    findings.faults.push_back({drawn.feature, drawn.line, drawn.zone.name,
                               "zone name '" + drawn.zone.name + "' (feature " +
                                   std::to_string(drawn.feature) + ") is taken by feature " +
                                   std::to_string(it->second) + "; rename one"});
  }
}

// False when the steps are used up.
bool check_overlap(const DrawnZone& a, const DrawnZone& b, MeasuringSteps& steps,
                   Findings& findings) {
  const std::optional<double> measured = common_area_m2(a.zone.polygon, b.zone.polygon, steps);
  if (!measured) {
    findings.faults.push_back(
        {b.feature, b.line, b.zone.name,
         "zones '" + a.zone.name + "' and '" + b.zone.name +
             "' cross in too many places to measure how far they overlap; no zones after them are "
             "compared: simplify their outlines (QGIS: Vector > Geometry Tools > Simplify)"});
    return false;
  }
  const double common = *measured;
  const double area_a = area_m2(a.zone.polygon), area_b = area_m2(b.zone.polygon);
  const double smaller = std::min(area_a, area_b);
  if (common <= kMaxOverlap * smaller) return true;
  const std::string& small_name = area_b <= area_a ? b.zone.name : a.zone.name;
  findings.faults.push_back(
      {b.feature,
       b.line,
       b.zone.name,
       "zones '" + a.zone.name + "' and '" + b.zone.name + "' overlap by " + number_text(common) +
           " m2, " + number_text(100 * common / smaller) + " % of '" + small_name +
           "'; at most 1 % is allowed: move the border that they share, or give zones on different "
           "floors z_min and z_max",
       {common_region(a.zone.polygon, b.zone.polygon, steps), {}, {}}});
  return true;
}

// Enough for any drawing of a building, and for some seconds of one that is none.
MeasuringSteps steps_for(std::uint64_t vertices) {
  constexpr std::uint64_t kFreeSteps = 200'000'000, kStepsPerVertex = 128;
  return MeasuringSteps(kFreeSteps + kStepsPerVertex * vertices);
}

std::uint64_t vertices_of(const Polygon& polygon) {
  std::uint64_t vertices = polygon.outer.size();
  for (const Ring& hole : polygon.holes) vertices += hole.size();
  return vertices;
}

void check_overlaps(const std::vector<DrawnZone>& zones, Findings& findings) {
  std::vector<Box2> boxes(zones.size());
  std::uint64_t vertices = 0;
  for (std::size_t i = 0; i < zones.size(); ++i) {
    if (zones[i].sound) boxes[i] = bounds(zones[i].zone.polygon.outer);
    vertices += vertices_of(zones[i].zone.polygon);
  }
  NearBoxes near(std::move(boxes));
  MeasuringSteps steps = steps_for(vertices);
  for (std::uint32_t i = 0; i < zones.size(); ++i) {
    if (!zones[i].sound) continue;
    std::uint64_t compared = 0;
    for (const std::uint32_t j : near.after(i, 0, compared)) {
      if (!zones[j].sound || !share_a_height(zones[i].zone, zones[j].zone)) continue;
      if (!check_overlap(zones[i], zones[j], steps, findings)) return;
    }
    steps.take(compared);
  }
}

void check_extent(const Drawing& drawing, Findings& findings) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Box2 box{{kInf, kInf}, {-kInf, -kInf}};
  for (const DrawnZone& drawn : drawing.zones) {
    if (drawn.zone.polygon.outer.empty()) continue;
    const Box2 b = bounds(drawn.zone.polygon.outer);
    box.min = {std::min(box.min.x_m, b.min.x_m), std::min(box.min.y_m, b.min.y_m)};
    box.max = {std::max(box.max.x_m, b.max.x_m), std::max(box.max.y_m, b.max.y_m)};
  }
  if (box.max.x_m - box.min.x_m < kMaxDegreesExtent &&
      box.max.y_m - box.min.y_m < kMaxDegreesExtent && box.max.x_m >= box.min.x_m) {
    findings.faults.push_back({std::nullopt, 0, "",
                               "all zones together lie between " + point_text(box.min) + " and " +
                                   point_text(box.max) +
                                   ", less than 10 cm apart: the coordinates look like degrees of "
                                   "longitude and latitude; "
                                   "save the zones in metres of the map frame (QGIS: in the "
                                   "project's CRS, not in WGS 84)"});
  }
}

}  // namespace

std::vector<OutlineFault> outline_faults(const Polygon& polygon) {
  std::vector<OutlineFault> faults;
  const std::uint64_t vertices = vertices_of(polygon);
  if (is_over(LimitId::kVerticesOfZone, vertices)) {
    const Limit& most = limit(LimitId::kVerticesOfZone);
    faults.push_back({"has " + std::to_string(vertices) + " vertices; at most " +
                      std::to_string(most.most) + " are allowed: " + most.remedy});
    return faults;
  }
  if (!check_ring(polygon.outer, "outline", faults)) return faults;
  const Polygon outer{polygon.outer, {}};
  std::vector<std::pair<std::size_t, Polygon>> sound;
  MeasuringSteps steps = steps_for(vertices);
  for (std::size_t i = 0; i < polygon.holes.size(); ++i) {
    const std::string what = "hole " + std::to_string(i + 1);
    if (!check_ring(polygon.holes[i], what, faults)) continue;
    const Polygon hole{polygon.holes[i], {}};
    const std::optional<double> inside = common_area_m2(hole, outer, steps);
    if (!inside || faults.size() > kMostOutlineFaults) {
      faults.push_back({"has holes that cross its outline or each other in too many places, " +
                        what +
                        " among them; simplify it (QGIS: Vector > Geometry Tools > Simplify)"});
      return faults;
    }
    if (area_m2(hole) - *inside > kMinZoneArea_m2) {
      faults.push_back({"has a hole outside its outline: " + what + " near " +
                            point_text(hole.outer[0]) + "; move the hole inside or delete it",
                        {{hole.outer}, {}, {}}});
      continue;
    }
    for (const auto& [other, placed] : sound) {
      if (common_area_m2(hole, placed, steps).value_or(0) > kMinZoneArea_m2) {
        faults.push_back({"has holes that overlap: hole " + std::to_string(other + 1) + " and " +
                              what + " near " + point_text(hole.outer[0]) + "; merge them",
                          {{hole.outer}, {}, {}}});
      }
    }
    sound.emplace_back(i, hole);
  }
  if (faults.empty() && area_m2(polygon) < kMinZoneArea_m2) {
    faults.push_back({"has no area: its holes take all of it; delete them"});
  }
  return faults;
}

void check_zones_together(const Drawing& drawing, Findings& findings) {
  check_names(drawing, findings);
  check_overlaps(drawing.zones, findings);
  check_extent(drawing, findings);
}

std::vector<std::uint32_t> unreachable_zones(const ZonePlan& plan) {
  std::vector<std::uint32_t> group(plan.zones.size());
  std::iota(group.begin(), group.end(), 0u);
  const auto root = [&](std::uint32_t zone) {
    while (group[zone] != zone) zone = group[zone] = group[group[zone]];
    return zone;
  };
  for (const PlannedPortal& portal : plan.portals) {
    const std::uint32_t a = root(portal.zone_a), b = root(portal.zone_b);
    group[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::size_t> size(plan.zones.size());
  for (std::uint32_t zone = 0; zone < group.size(); ++zone) ++size[root(zone)];
  const auto largest =
      static_cast<std::uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<std::uint32_t> apart;
  for (std::uint32_t zone = 0; zone < group.size(); ++zone) {
    if (root(zone) != largest) apart.push_back(zone);
  }
  return apart;
}

}  // namespace zonepack::packer
