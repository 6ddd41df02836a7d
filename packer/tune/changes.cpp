// SPDX-License-Identifier: Apache-2.0
#include "packer/tune/changes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "packer/zones/shared_border.hpp"
#include "packer/zones/slabs.hpp"
#include "packer/zones/zone_file.hpp"
#include "platform/base/natural_order.hpp"
#include "runtime/pack_format/limits.hpp"

namespace zonepack::packer::tune {
namespace {

constexpr double kSeam_m = 1e-6;  // parts touch along a cut exactly, up to rounding

struct Extent {
  double from = 0, to = 0;
};

Extent extent_of(const Polygon& polygon, const Axis& axis) {
  Extent extent{axis.at(polygon.outer.front()), axis.at(polygon.outer.front())};
  for (const Point2 p : polygon.outer) {
    extent.from = std::min(extent.from, axis.at(p));
    extent.to = std::max(extent.to, axis.at(p));
  }
  return extent;
}

// A cut may part a passage over open ground, but no door, and leaves no narrow rest of any.
bool spoils_a_portal(const Layout& layout, std::uint32_t zone, const Axis& axis, double place) {
  return std::ranges::any_of(layout.portals, [&](const PlannedPortal& portal) {
    if (portal.zone_a != zone && portal.zone_b != zone) return false;
    const double p = axis.at(portal.segment.p) - place, q = axis.at(portal.segment.q) - place;
    const double near = std::min(std::abs(p), std::abs(q));
    if (p * q > 0) return near < kPortalMargin_m;
    const double width = distance_m(portal.segment.p, portal.segment.q);
    const double share = std::abs(p) + std::abs(q) > 0 ? near / (std::abs(p) + std::abs(q)) : 0;
    return width < kOpenGround_m || share * width < kLeastSeam_m;
  });
}

// The two sides of a portal that a cut parts, in the order of the axis.
std::pair<Segment2, Segment2> parted(const Segment2& portal, const Axis& axis, double place) {
  const double p = axis.at(portal.p) - place, q = axis.at(portal.q) - place;
  const double t = p / (p - q);
  const Point2 at{portal.p.x_m + t * (portal.q.x_m - portal.p.x_m),
                  portal.p.y_m + t * (portal.q.y_m - portal.p.y_m)};
  const Segment2 first{portal.p, at}, second{at, portal.q};
  return p < 0 ? std::pair(first, second) : std::pair(second, first);
}

PackCost estimated(const Layout& layout, std::span<const Signature> signatures,
                   const std::vector<std::uint32_t>& from, const std::vector<std::uint32_t>& mine) {
  double all = 0, part = 0;
  ByteCount stored = 0;
  std::uint64_t slots = 0, chunks = 0;
  for (const std::uint32_t zone : from) {
    for (const std::uint32_t i : layout.zones[zone].members) all += signatures[i].decoded;
    stored += layout.zones[zone].cost.stored;
    slots += layout.zones[zone].cost.slots;
    chunks += layout.zones[zone].cost.chunks;
  }
  for (const std::uint32_t i : mine) part += signatures[i].decoded;
  const double share = all > 0 ? part / all : 0;
  // Half a slot of the whole is empty at its end, on average.
  const double filled = std::max(0.0, static_cast<double>(slots) - 0.5);
  return {static_cast<std::uint32_t>(std::ceil(share * filled)),
          static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(chunks))),
          static_cast<ByteCount>(std::llround(share * static_cast<double>(stored))), false};
}

std::set<std::string> names_in(const Layout& layout) {
  std::set<std::string> names;
  for (const TunedZone& zone : layout.zones) {
    if (zone.alive) names.insert(zone.zone.name);
  }
  return names;
}

std::set<std::string> portal_names_in(const Layout& layout) {
  std::set<std::string> names;
  for (const PlannedPortal& portal : layout.portals) names.insert(portal.name);
  return names;
}

// Two names that no zone has: NAME_1 and NAME_2, or the next two numbers that are free.
std::optional<std::vector<std::string>> part_names(const Layout& layout, const std::string& name) {
  const std::set<std::string> taken = names_in(layout);
  std::vector<std::string> names;
  for (std::size_t number = 1; names.size() < 2; ++number) {
    std::string part = name + "_" + std::to_string(number);
    if (find_name_problem(part)) return std::nullopt;
    if (!taken.contains(part)) names.push_back(std::move(part));
  }
  return names;
}

// NAME.1, NAME.2 and so on, as a build numbers the pieces of a portal.
std::string fresh_name(const std::string& portal, std::set<std::string>& taken) {
  for (std::size_t number = 1;; ++number) {
    std::string name = portal + "." + std::to_string(number);
    if (taken.insert(name).second) return name;
  }
}

std::optional<Changed> split(const Layout& layout, std::span<const Signature> signatures,
                             const Change& change) {
  const TunedZone& whole = layout.zones[change.zone_a];
  Pieces pieces = cut(whole.zone.polygon, change.axis, change.place_m);
  if (pieces.below.size() != 1 || pieces.above.size() != 1) return std::nullopt;
  auto names = part_names(layout, whole.zone.name);
  if (!names) return std::nullopt;
  const auto seams = shared_borders(pieces.below[0], pieces.above[0], kSeam_m, kMinFoundPortal_m);
  if (!seams || std::ranges::none_of(*seams, [](const Segment2& seam) {
        return distance_m(seam.p, seam.q) >= kLeastSeam_m;
      })) {
    return std::nullopt;
  }
  Changed result{layout, {{whole.zone.name}, *names}, {}};
  Layout& out = result.layout;
  out.zones[change.zone_a].alive = false;
  std::vector<PlannedZone> parts(2, whole.zone);
  for (std::size_t i = 0; i < 2; ++i) {
    parts[i].name = (*names)[i];
    parts[i].parent.clear();
    parts[i].polygon = std::move(i == 0 ? pieces.below[0] : pieces.above[0]);
  }
  std::vector<SignaturePlace> places;
  for (const std::uint32_t i : whole.members) places.push_back(signatures[i].place);
  const std::vector<std::uint32_t> owner = partition(parts, places, OrphanPolicy::kNearest).zone_of;
  for (std::uint32_t part = 0; part < 2; ++part) {
    TunedZone zone = whole;
    zone.zone = std::move(parts[part]);
    zone.changed = true;
    zone.members.clear();
    for (std::size_t i = 0; i < owner.size(); ++i) {
      if (owner[i] == part) zone.members.push_back(whole.members[i]);
    }
    if (zone.members.empty()) return std::nullopt;
    zone.cost = estimated(layout, signatures, {change.zone_a}, zone.members);
    result.fresh.push_back(static_cast<std::uint32_t>(out.zones.size()));
    out.zones.push_back(std::move(zone));
  }
  std::set<std::string> taken = portal_names_in(layout);
  std::vector<PlannedPortal> portals;
  const auto attach = [&](PlannedPortal portal, const Segment2& segment, std::size_t part) {
    (portal.zone_a == change.zone_a ? portal.zone_a : portal.zone_b) = result.fresh[part];
    portal.segment = segment;
    portals.push_back(std::move(portal));
  };
  for (const PlannedPortal& portal : layout.portals) {
    if (portal.zone_a != change.zone_a && portal.zone_b != change.zone_a) {
      portals.push_back(portal);
      continue;
    }
    const double p = change.axis.at(portal.segment.p) - change.place_m;
    const double q = change.axis.at(portal.segment.q) - change.place_m;
    if (p * q > 0) {
      attach(portal, portal.segment, p < 0 ? 0 : 1);
      continue;
    }
    const auto [below, above] = parted(portal.segment, change.axis, change.place_m);
    PlannedPortal piece = portal;
    piece.name = fresh_name(portal.name, taken);
    attach(piece, below, 0);
    piece.name = fresh_name(portal.name, taken);
    attach(piece, above, 1);
  }
  out.portals = std::move(portals);
  for (const Segment2& seam : *seams) {
    out.portals.push_back({fresh_portal_name((*names)[0], (*names)[1], taken), result.fresh[0],
                           result.fresh[1], seam});
  }
  return result;
}

// "a", "b" or "a + b".
std::string both_labels(const std::string& a, const std::string& b) {
  if (a.empty() || a == b) return b;
  return b.empty() ? a : a + " + " + b;
}

std::optional<Changed> merge(const Layout& layout, std::span<const Signature> signatures,
                             const Change& change) {
  const TunedZone &a = layout.zones[change.zone_a], &b = layout.zones[change.zone_b];
  std::optional<Polygon> polygon = joined(a.zone.polygon, b.zone.polygon);
  if (!polygon) return std::nullopt;
  const bool in_order = natural_less(a.zone.name, b.zone.name);
  const std::string &first = (in_order ? a : b).zone.name, &second = (in_order ? b : a).zone.name;
  const std::string name = first + "+" + second;
  if (find_name_problem(name) || names_in(layout).contains(name)) return std::nullopt;
  Changed result{layout, {{first, second}, {name}}, {}};
  Layout& out = result.layout;
  out.zones[change.zone_a].alive = out.zones[change.zone_b].alive = false;
  TunedZone zone = a.members.size() >= b.members.size() ? a : b;  // keeps the larger one's type
  zone.zone.name = name;
  zone.zone.parent.clear();
  zone.zone.label = both_labels((in_order ? a : b).zone.label, (in_order ? b : a).zone.label);
  zone.zone.polygon = std::move(*polygon);
  zone.changed = true;
  zone.members.clear();
  std::ranges::merge(a.members, b.members, std::back_inserter(zone.members));
  zone.cost = estimated(layout, signatures, {change.zone_a, change.zone_b}, zone.members);
  const auto index = static_cast<std::uint32_t>(out.zones.size());
  result.fresh = {index};
  out.zones.push_back(std::move(zone));
  std::vector<PlannedPortal> portals;
  for (PlannedPortal portal : layout.portals) {
    for (std::uint32_t* const end : {&portal.zone_a, &portal.zone_b}) {
      if (*end == change.zone_a || *end == change.zone_b) *end = index;
    }
    if (portal.zone_a != portal.zone_b) portals.push_back(std::move(portal));
  }
  const auto mine = static_cast<std::size_t>(std::ranges::count_if(
      portals, [&](const auto& p) { return p.zone_a == index || p.zone_b == index; }));
  if (mine > kMaxPortalsPerZone) return std::nullopt;
  out.portals = std::move(portals);
  return result;
}

}  // namespace

std::vector<Change> splits_of(const Layout& layout, std::span<const Signature> signatures,
                              std::uint32_t zone, std::size_t most) {
  const TunedZone& whole = layout.zones[zone];
  std::vector<Change> changes;
  if (!whole.alive || whole.pinned || !whole.loaded || whole.cost.slots < 2 ||
      whole.members.size() < 2) {
    return changes;
  }
  const Axis length = length_of(whole.zone.polygon);
  for (const Axis& axis : {length, length.across()}) {
    const Extent extent = extent_of(whole.zone.polygon, axis);
    std::vector<double> stops;  // where signatures stand
    for (const std::uint32_t i : whole.members) {
      stops.push_back(axis.at(signatures[i].place.p_map));
    }
    std::sort(stops.begin(), stops.end());
    const double first = std::max(extent.from + kLeastPart_m, stops.front());
    const double last = std::min(extent.to - kLeastPart_m, stops.back());
    if (first >= last) continue;
    double before = -INFINITY;
    for (std::size_t i = 0; i < most; ++i) {
      const double wanted =
          first + (last - first) * (static_cast<double>(i) + 0.5) / static_cast<double>(most);
      const auto above = std::ranges::upper_bound(stops, wanted);
      if (above == stops.begin() || above == stops.end()) continue;
      const double from = std::max(*std::prev(above), first), to = std::min(*above, last);
      if (to - from < kOnePlace_m) continue;
      const double place = place_between(whole.zone.polygon, axis, from, to);
      if (place <= before || spoils_a_portal(layout, zone, axis, place)) continue;
      before = place;
      changes.push_back({Change::Kind::kSplit, zone, zone, axis, place});
    }
  }
  return changes;
}

std::vector<Change> merges_of(const Layout& layout) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const PlannedPortal& portal : layout.portals) {
    pairs.insert(std::minmax(portal.zone_a, portal.zone_b));
  }
  std::vector<Change> changes;
  for (const auto& [i, k] : pairs) {
    const TunedZone &a = layout.zones[i], &b = layout.zones[k];
    if (a.pinned || b.pinned || !a.loaded || !b.loaded || a.zone.layer != b.zone.layer ||
        a.zone.floor != b.zone.floor || a.zone.z_min_m != b.zone.z_min_m ||
        a.zone.z_max_m != b.zone.z_max_m) {
      continue;
    }
    changes.push_back({Change::Kind::kMerge, i, k, {}, 0});
  }
  return changes;
}

std::optional<Changed> changed(const Layout& layout, std::span<const Signature> signatures,
                               const Change& change) {
  return change.kind == Change::Kind::kSplit ? split(layout, signatures, change)
                                             : merge(layout, signatures, change);
}

std::vector<Visit> visits_after(const Track& track, const Change& change, const Changed& changed) {
  std::vector<Visit> visits;
  const auto add = [&](std::uint32_t zone, std::size_t first, std::size_t last) {
    if (!visits.empty() && visits.back().zone == zone) {
      visits.back().last = last;
    } else {
      visits.push_back({zone, first, last});
    }
  };
  for (const Visit& visit : track.visits) {
    if (change.kind == Change::Kind::kMerge) {
      const bool mine = visit.zone == change.zone_a || visit.zone == change.zone_b;
      add(mine ? changed.fresh[0] : visit.zone, visit.first, visit.last);
      continue;
    }
    if (visit.zone != change.zone_a) {
      add(visit.zone, visit.first, visit.last);
      continue;
    }
    std::size_t part = 2;  // none yet
    std::size_t begin = visit.first;
    for (std::size_t i = visit.first; i <= visit.last; ++i) {
      const Place& place = track.places[i];
      if (place.zone != change.zone_a) continue;
      const double off = change.axis.at(place.p_map) - change.place_m;
      const std::size_t side = off < 0 ? 0 : 1;
      if (side == part || (part != 2 && std::abs(off) < kEntered_m)) continue;
      if (part != 2) {
        add(changed.fresh[part], begin, i - 1);
        begin = i;
      }
      part = side;
    }
    if (part == 2) part = 0;  // passed on its border only
    add(changed.fresh[part], begin, visit.last);
  }
  return visits;
}

void follow(Track& track, const Change& change, const Changed& changed) {
  track.visits = visits_after(track, change, changed);
  for (Place& place : track.places) {
    if (change.kind == Change::Kind::kMerge) {
      if (place.zone != change.zone_a && place.zone != change.zone_b) continue;
      place.zone = changed.fresh[0];
      place.depth_m = static_cast<float>(
          distance_to_border_m(changed.layout.zones[changed.fresh[0]].zone.polygon, place.p_map));
      continue;
    }
    if (place.zone != change.zone_a) continue;
    const double off = change.axis.at(place.p_map) - change.place_m;
    place.zone = changed.fresh[off < 0 ? 0 : 1];
    place.depth_m = std::min(place.depth_m, static_cast<float>(std::abs(off)));
  }
}

}  // namespace zonepack::packer::tune
