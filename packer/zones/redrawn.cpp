// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/redrawn.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "packer/zones/drawn.hpp"
#include "packer/zones/geojson.hpp"
#include "packer/zones/portals.hpp"
#include "packer/zones/zone_checks.hpp"
#include "packer/zones/zone_file.hpp"

namespace zonepack::packer {
namespace {

constexpr double kSameVertex_m = 1e-6;

bool same_ring(const Ring& a, const Ring& b) {
  if (a.size() != b.size()) return false;
  // Another first vertex draws the same ring.
  for (std::size_t shift = 0; shift < a.size(); ++shift) {
    bool same = true;
    for (std::size_t i = 0; same && i < a.size(); ++i) {
      const Point2 p = a[i], q = b[(i + shift) % b.size()];
      same = std::abs(p.x_m - q.x_m) <= kSameVertex_m && std::abs(p.y_m - q.y_m) <= kSameVertex_m;
    }
    if (same) return true;
  }
  return false;
}

bool same_outline(const PlannedZone& a, const PlannedZone& b) {
  const Polygon &p = a.polygon, &q = b.polygon;
  if (a.z_min_m != b.z_min_m || a.z_max_m != b.z_max_m || p.holes.size() != q.holes.size()) {
    return false;
  }
  return same_ring(p.outer, q.outer) &&
         std::equal(p.holes.begin(), p.holes.end(), q.holes.begin(), same_ring);
}

class Redrawing {
 public:
  Redrawing(const ZonePlan& held, const std::string& path, double snap_m)
      : held_(held), path_(path), snap_m_(snap_m) {
    const std::string text = read_zone_text(path);
    drawing_ = read_drawing(read_features(text, findings_), findings_);
    throw_faults();
    for (const PlannedZone& zone : held.zones) {
      names_.insert(zone.name);
      if (!zone.parent.empty()) parents_.insert(zone.parent);
    }
  }

  Redrawn replace(const std::set<std::string>& replaced) {
    std::set<std::string> drawn;
    for (const DrawnZone& zone : drawing_.zones) drawn.insert(zone.zone.name);
    for (const std::string& name : replaced) {
      if (drawn.contains(name)) continue;
      throw std::runtime_error(path_ + ": draws no zone '" + name +
                               "', which --replace names; leave --zones out to keep its outline");
    }
    std::erase_if(drawing_.zones, [&](const DrawnZone& zone) {
      const std::string& name = zone.zone.name;
      if (replaced.contains(name)) return false;
      if (!in_map(name)) result_.not_taken.push_back(name);
      return true;
    });
    return merged(replaced);
  }

  Redrawn add() {
    std::erase_if(drawing_.zones, [this](const DrawnZone& drawn) {
      if (!in_map(drawn.zone.name)) return false;
      refuse_redrawn(drawn);
      return true;
    });
    return merged({});
  }

 private:
  void throw_faults() const {
    if (!findings_.faults.empty()) throw std::runtime_error(describe_faults(findings_, path_));
  }

  bool in_map(const std::string& name) const {
    return names_.contains(name) || parents_.contains(name);
  }

  void refuse_redrawn(const DrawnZone& drawn) const {
    for (const PlannedZone& zone : held_.zones) {
      if (zone.name != drawn.zone.name || same_outline(zone, drawn.zone)) continue;
      throw std::runtime_error(path_ + ":" + std::to_string(drawn.line) + ": zone '" + zone.name +
                               "' is drawn otherwise than in the map, and --add leaves the map's "
                               "zones as they are; give it another name, or take the new outline "
                               "with --replace " +
                               zone.name);
    }
  }

  // A portal that is drawn to a zone that was split leads to the part that it touches.
  void resolve_parts() {
    for (DrawnPortal& portal : drawing_.portals) {
      const Point2 middle{(portal.segment.p.x_m + portal.segment.q.x_m) / 2,
                          (portal.segment.p.y_m + portal.segment.q.y_m) / 2};
      for (std::string& name : portal.zones) {
        const std::string parent = name;
        if (fresh_.contains(parent)) continue;
        double nearest = INFINITY;
        for (const PlannedZone& zone : held_.zones) {
          if (zone.parent != parent) continue;
          const double distance = distance_to_border_m(zone.polygon, middle);
          if (distance >= nearest) continue;
          nearest = distance;
          name = zone.name;
        }
      }
    }
  }

  Redrawn merged(const std::set<std::string>& replaced) {
    for (const DrawnZone& drawn : drawing_.zones) fresh_.insert(drawn.zone.name);
    resolve_parts();
    // Portals between zones that stay are the map's own; those to zones that are not taken lead
    // nowhere.
    const std::set<std::string> nowhere(result_.not_taken.begin(), result_.not_taken.end());
    std::erase_if(drawing_.portals, [&](const DrawnPortal& portal) {
      const auto& [a, b] = portal.zones;
      return (!fresh_.contains(a) && !fresh_.contains(b)) || nowhere.contains(a) ||
             nowhere.contains(b);
    });
    const std::size_t first_held = drawing_.zones.size();
    for (const PlannedZone& zone : held_.zones) {
      if (replaced.contains(zone.name) || replaced.contains(zone.parent)) continue;
      drawing_.zones.push_back(
          {.feature = first_held + drawing_.zones.size(), .line = 0, .zone = zone, .sound = true});
    }
    check_zones_together(drawing_, findings_);
    throw_faults();
    ZonePlan& plan = result_.plan;
    for (const DrawnZone& drawn : drawing_.zones) plan.zones.push_back(drawn.zone);
    sort_by_name(plan);
    if (drawing_.portal_features > 0) {
      place_portals(drawing_, snap_m_, plan, findings_);
    } else {
      find_portals(snap_m_, plan, findings_);
    }
    throw_faults();
    keep_portals();
    for (const Finding& finding : findings_.warnings) {
      if (finding.name.empty() || fresh_.contains(finding.name)) {
        result_.warnings.push_back(to_string(finding, path_));
      }
    }
    for (const std::uint32_t zone : unreachable_zones(plan)) {
      result_.warnings.push_back(path_ + ": zone '" + plan.zones[zone].name +
                                 "' is unreachable: no portals join it to the other zones; draw a "
                                 "portal, or let its border meet its neighbour's");
    }
    result_.fresh = fresh_;
    return std::move(result_);
  }

  // Of what was found or drawn, the portals of fresh zones; of the map, those of the others.
  void keep_portals() {
    ZonePlan& plan = result_.plan;
    std::map<std::string, std::uint32_t> place;
    for (std::uint32_t i = 0; i < plan.zones.size(); ++i) place[plan.zones[i].name] = i;
    std::erase_if(plan.portals, [&](const PlannedPortal& portal) {
      return !fresh_.contains(plan.zones[portal.zone_a].name) &&
             !fresh_.contains(plan.zones[portal.zone_b].name);
    });
    std::vector<PlannedPortal> kept;
    std::set<std::string> taken;
    for (const PlannedPortal& portal : held_.portals) {
      const auto a = place.find(held_.zones[portal.zone_a].name);
      const auto b = place.find(held_.zones[portal.zone_b].name);
      if (a == place.end() || b == place.end()) continue;
      if (fresh_.contains(a->first) || fresh_.contains(b->first)) continue;
      kept.push_back({portal.name, a->second, b->second, portal.segment});
      taken.insert(portal.name);
    }
    for (PlannedPortal& portal : plan.portals) {
      if (!taken.insert(portal.name).second) {
        portal.name = fresh_portal_name(plan.zones[portal.zone_a].name,
                                        plan.zones[portal.zone_b].name, taken);
      }
      kept.push_back(std::move(portal));
    }
    plan.portals = std::move(kept);
    sort_by_name(plan);
  }

  const ZonePlan& held_;
  const std::string& path_;
  double snap_m_;
  Drawing drawing_;
  Findings findings_;
  std::set<std::string> names_, parents_, fresh_;
  Redrawn result_;
};

}  // namespace

Redrawn redraw(const ZonePlan& held, const std::string& path, double snap_m,
               const std::set<std::string>& replaced) {
  return Redrawing(held, path, snap_m).replace(replaced);
}

Redrawn add_zones(const ZonePlan& held, const std::string& path, double snap_m) {
  return Redrawing(held, path, snap_m).add();
}

}  // namespace zonepack::packer
