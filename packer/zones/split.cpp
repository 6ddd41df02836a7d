// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/split.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "packer/zones/findings.hpp"
#include "packer/zones/plane.hpp"
#include "packer/zones/shared_border.hpp"
#include "packer/zones/zone_file.hpp"
#include "packer/zones/zone_parts.hpp"
#include "platform/base/require.hpp"

namespace zonepack::packer {
namespace {

constexpr double kSeam_m = 1e-6;         // parts touch along a cut exactly, up to rounding
constexpr double kLeastPortal_m = 1e-3;  // a shorter rest of a portal joins its neighbour
constexpr std::size_t kSignaturesNamed = 10;

// The parts of one zone: a range of the new plan's zones.
struct PartRange {
  std::uint32_t first = 0, count = 0;
  std::vector<Segment2> seams;
};

struct Stretch {
  Segment2 segment;
  std::uint32_t part = 0;
};

Point2 between(const Segment2& s, double t) noexcept {
  if (t == 1) return s.q;
  return {s.p.x_m + t * (s.q.x_m - s.p.x_m), s.p.y_m + t * (s.q.y_m - s.p.y_m)};
}

// Where along a portal, from 0 to 1, the zone was cut.
std::vector<double> stops_along(const Segment2& portal, const Polygon& zone,
                                const std::vector<Segment2>& seams) {
  double reach = 0;  // a cut ends on the zone's border, but the portal may be off it
  for (const double t : {0.0, 0.5, 1.0}) {
    reach = std::max(reach, distance_to_border_m(zone, between(portal, t)));
  }
  const double length = distance_m(portal.p, portal.q);
  std::vector<double> stops{0, 1};
  for (const Segment2& seam : seams) {
    for (const Point2 end : {seam.p, seam.q}) {
      const Point2 foot = zonepack::nearest_point(portal, end);
      const double from_p = distance_m(portal.p, foot), from_q = distance_m(portal.q, foot);
      if (distance_m(foot, end) <= reach + kSeam_m && std::min(from_p, from_q) >= kLeastPortal_m) {
        stops.push_back(from_p / length);
      }
    }
  }
  std::sort(stops.begin(), stops.end());
  return stops;
}

class PlanSplitter {
 public:
  PlanSplitter(const ZonePlan& plan, std::span<const SignaturePlace> signatures,
               std::span<const std::uint32_t> zone_of, std::span<const ByteCount> weights,
               ByteCount limit)
      : plan_(plan), signatures_(signatures), zone_of_(zone_of), weights_(weights), limit_(limit) {
    ZP_REQUIRE(zone_of.size() == signatures.size() && weights.size() == signatures.size());
    for (const PlannedZone& zone : plan.zones) zone_names_.insert(zone.name);
    for (const PlannedPortal& portal : plan.portals) portal_names_.insert(portal.name);
  }

  SplitPlan run() {
    result_.zone_of.assign(signatures_.size(), Partition::kNone);
    result_.plan.portals_found = plan_.portals_found;
    std::vector<std::vector<std::size_t>> members(plan_.zones.size());
    for (std::size_t i = 0; i < signatures_.size(); ++i) {
      if (zone_of_[i] != Partition::kNone) members[zone_of_[i]].push_back(i);
    }
    for (std::uint32_t zone = 0; zone < plan_.zones.size(); ++zone) add_zone(zone, members[zone]);
    if (heaviest_) refuse();
    for (const PlannedPortal& portal : plan_.portals) attach(portal);
    const std::vector<std::uint32_t> place = sort_by_name(result_.plan);
    for (std::uint32_t& zone : result_.zone_of) {
      if (zone != Partition::kNone) zone = place[zone];
    }
    return std::move(result_);
  }

 private:
  std::vector<PlannedZone>& zones() { return result_.plan.zones; }

  void note_heaviest(const std::string& zone, const std::optional<Inseparable>& heaviest) {
    if (!heaviest || (heaviest_ && heaviest->weight <= heaviest_->weight)) return;
    heaviest_ = heaviest;
    heaviest_zone_ = zone;
  }

  [[noreturn]] void refuse() const {
    std::string who = "signature " + std::to_string(heaviest_->signatures[0]) + " alone needs ";
    if (heaviest_->signatures.size() > 1) {
      who = "signatures";
      for (std::size_t i = 0; i < heaviest_->signatures.size() && i < kSignaturesNamed; ++i) {
        who += (i == 0 ? " " : ", ") + std::to_string(heaviest_->signatures[i]);
      }
      if (heaviest_->signatures.size() > kSignaturesNamed) who += " …";
      who += " stand at one place, " + point_text(heaviest_->p_map) + ", and together need ";
    }
    const std::string need = std::to_string(heaviest_->weight);
    throw std::runtime_error("zone '" + heaviest_zone_ + "' cannot be split below " +
                             format_byte_count(limit_) + ": its " + who + need +
                             " bytes; raise --max-zone-bytes to " + need + " or more");
  }

  void add_zone(std::uint32_t zone, const std::vector<std::size_t>& indices) {
    const PlannedZone& whole = plan_.zones[zone];
    std::vector<Member> members;
    ByteCount weight = 0;
    for (const std::size_t i : indices) {
      members.push_back({signatures_[i], weights_[i]});
      weight += weights_[i];
    }
    ranges_.push_back({static_cast<std::uint32_t>(zones().size()), 1, {}});
    if (weight <= limit_) {
      for (const std::size_t i : indices) result_.zone_of[i] = ranges_.back().first;
      zones().push_back(whole);
      return;
    }
    ZoneParts cut = parts_of(whole.polygon, members, limit_);
    note_heaviest(whole.name, cut.heaviest);
    std::vector<Polygon>& parts = cut.polygons;
    ranges_.back().count = static_cast<std::uint32_t>(parts.size());
    result_.split.push_back({whole.name, parts.size(), weight, cut.narrow_limit});
    for (std::size_t i = 0; i < parts.size(); ++i) {
      zones().push_back(whole);
      zones().back().name = part_name(whole.name, i + 1);
      zones().back().parent = whole.name;
      zones().back().polygon = std::move(parts[i]);
    }
    give_out(indices, ranges_.back());
    join_parts(ranges_.back());
  }

  std::string part_name(const std::string& zone, std::size_t number) {
    std::string name = zone + "." + std::to_string(number);
    if (const auto problem = find_name_problem(name)) {
      throw std::runtime_error("zone '" + zone + "' cannot be split: the name of its part '" +
                               name + "' is unfit: " + *problem + "; give the zone a shorter name");
    }
    if (!zone_names_.insert(name).second) {
      throw std::runtime_error("zone '" + zone + "' cannot be split: there is a zone '" + name +
                               "' already, which would be the name of a part; rename that zone");
    }
    return name;
  }

  // Applies the rule of partition.hpp to the parts, which it needs sorted by name.
  void give_out(const std::vector<std::size_t>& indices, const PartRange& range) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < range.count; ++i) order.push_back(range.first + i);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return zones()[a].name < zones()[b].name; });
    std::vector<PlannedZone> parts;
    parts.reserve(order.size());
    for (const std::uint32_t part : order) parts.push_back(zones()[part]);
    std::vector<SignaturePlace> places;
    places.reserve(indices.size());
    for (const std::size_t i : indices) places.push_back(signatures_[i]);
    const Partition among = partition(parts, places, OrphanPolicy::kNearest);
    for (std::size_t i = 0; i < indices.size(); ++i) {
      result_.zone_of[indices[i]] = order[among.zone_of[i]];
    }
  }

  void join_parts(PartRange& range) {
    const std::uint32_t end = range.first + range.count;
    for (std::uint32_t a = range.first; a < end; ++a) {
      for (std::uint32_t b = a + 1; b < end; ++b) {
        const auto seams = shared_borders(zones()[a].polygon, zones()[b].polygon, kSeam_m, kSeam_m);
        if (!seams) {
          throw std::runtime_error(
              "zones '" + zones()[a].name + "' and '" + zones()[b].name +
              "' share a border of more than " + std::to_string(kMostBorderPieces) +
              " pieces; simplify the outline of zone '" + zones()[a].parent + "'");
        }
        for (const Segment2& seam : *seams) {
          std::string name = fresh_portal_name(zones()[a].name, zones()[b].name, portal_names_);
          result_.plan.portals.push_back({std::move(name), a, b, seam});
          range.seams.push_back(seam);
        }
      }
    }
  }

  std::vector<Stretch> stretches(const Segment2& portal, std::uint32_t zone) {
    const PartRange& range = ranges_[zone];
    if (range.count == 1) return {{portal, range.first}};
    const std::vector<double> stops = stops_along(portal, plan_.zones[zone].polygon, range.seams);
    std::vector<Stretch> found;
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
      if (stops[i + 1] <= stops[i]) continue;
      const std::uint32_t part =
          nearest_part(range, between(portal, (stops[i] + stops[i + 1]) / 2));
      if (!found.empty() && found.back().part == part) {
        found.back().segment.q = between(portal, stops[i + 1]);
      } else {
        found.push_back({{between(portal, stops[i]), between(portal, stops[i + 1])}, part});
      }
    }
    return found;
  }

  std::uint32_t nearest_part(const PartRange& range, Point2 point) {
    std::uint32_t nearest = range.first;
    double least = distance_to_area_m(zones()[nearest].polygon, point);
    for (std::uint32_t part = range.first + 1; part < range.first + range.count; ++part) {
      const double distance = distance_to_area_m(zones()[part].polygon, point);
      if (distance < least) {
        least = distance;
        nearest = part;
      }
    }
    return nearest;
  }

  void attach(const PlannedPortal& portal) {
    std::vector<PlannedPortal> pieces;
    for (const Stretch& a : stretches(portal.segment, portal.zone_a)) {
      for (const Stretch& b : stretches(a.segment, portal.zone_b)) {
        pieces.push_back({portal.name, a.part, b.part, b.segment});
      }
    }
    std::size_t number = 0;
    for (PlannedPortal& piece : pieces) {
      if (pieces.size() > 1) {
        do {
          piece.name = portal.name + "." + std::to_string(++number);
        } while (!portal_names_.insert(piece.name).second);
      }
      result_.plan.portals.push_back(std::move(piece));
    }
  }

  const ZonePlan& plan_;
  std::span<const SignaturePlace> signatures_;
  std::span<const std::uint32_t> zone_of_;
  std::span<const ByteCount> weights_;
  const ByteCount limit_;
  std::set<std::string> zone_names_, portal_names_;
  std::vector<PartRange> ranges_;
  std::optional<Inseparable> heaviest_;
  std::string heaviest_zone_;
  SplitPlan result_;
};

}  // namespace

SplitPlan split_oversized(const ZonePlan& plan, std::span<const SignaturePlace> signatures,
                          std::span<const std::uint32_t> zone_of,
                          std::span<const ByteCount> weights, ByteCount limit) {
  return PlanSplitter(plan, signatures, zone_of, weights, limit).run();
}

}  // namespace zonepack::packer
