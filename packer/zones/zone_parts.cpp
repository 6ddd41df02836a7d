// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/zone_parts.hpp"

#include <algorithm>
#include <utility>

#include "packer/zones/cut.hpp"
#include "packer/zones/shared_border.hpp"
#include "packer/zones/slabs.hpp"

namespace zonepack::packer {
namespace {

struct Anchored {
  const Member* member = nullptr;
  Point2 anchor;  // its position or, outside the zone, the nearest point of the outline
};

struct Part {
  Polygon polygon;
  std::vector<Anchored> members;
};

ByteCount weight_of(const Part& part) {
  ByteCount sum = 0;
  for (const Anchored& anchored : part.members) sum += anchored.member->weight;
  return sum;
}

Point2 anchor_of(const Polygon& polygon, Point2 point) {
  if (side_of(polygon, point) != Side::kOutside) return point;
  std::vector<Segment2> edges;
  for_each_edge(polygon, [&](const Segment2& edge) { edges.push_back(edge); });
  return nearest_point(edges, point).value();
}

std::vector<std::uint32_t> owners(const std::vector<Part>& parts,
                                  const std::vector<Anchored>& members) {
  std::vector<PlannedZone> zones(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) zones[i].polygon = parts[i].polygon;
  std::vector<SignaturePlace> places;
  places.reserve(members.size());
  for (const Anchored& anchored : members) places.push_back(anchored.member->place);
  return partition(zones, places, OrphanPolicy::kNearest).zone_of;
}

std::vector<Part> slabs_of(const Part& part, const Axis& axis, const std::vector<Gap>& cuts) {
  std::vector<Part> slabs;
  std::vector<Polygon> rest{part.polygon};
  for (const Gap& gap : cuts) {
    const double place = place_between(part.polygon, axis, gap.from_m, gap.to_m);
    std::vector<Polygon> above;
    for (const Polygon& polygon : rest) {
      Pieces pieces = cut(polygon, axis, place);
      for (Polygon& piece : pieces.below) slabs.push_back({std::move(piece), {}});
      for (Polygon& piece : pieces.above) above.push_back(std::move(piece));
    }
    rest = std::move(above);
  }
  for (Polygon& polygon : rest) slabs.push_back({std::move(polygon), {}});
  return slabs;
}

class Splitter {
 public:
  explicit Splitter(ByteCount limit) : limit_(limit) {}

  // Appends the parts in order along the length.
  void split(Part part) {
    const ByteCount weight = weight_of(part);
    if (weight <= limit_) {
      found_.polygons.push_back(std::move(part.polygon));
      return;
    }
    const Axis length = length_of(part.polygon);
    for (const double one_place_m : {kOnePlace_m, 0.0}) {
      for (const Axis& axis : {length, length.across()}) {
        std::vector<Part> slabs = divided(part, axis, one_place_m);
        const bool progress = std::all_of(slabs.begin(), slabs.end(), [&](const Part& slab) {
          return slab.members.size() < part.members.size();
        });
        if (!progress) continue;
        if (one_place_m == 0) found_.narrow_limit = std::max(found_.narrow_limit, weight);
        for (Part& slab : slabs) split(std::move(slab));
        return;
      }
    }
    if (!found_.heaviest || weight > found_.heaviest->weight) note(part, weight);
    found_.polygons.push_back(std::move(part.polygon));
  }

  ZoneParts found() { return std::move(found_); }

 private:
  std::vector<Part> divided(const Part& part, const Axis& axis, double one_place_m) const {
    std::vector<Weight> weights;
    for (const Anchored& anchored : part.members) {
      weights.push_back({axis.at(anchored.anchor), anchored.member->weight});
    }
    std::stable_sort(weights.begin(), weights.end(),
                     [](const Weight& a, const Weight& b) { return a.place_m < b.place_m; });
    std::vector<Part> slabs = slabs_of(part, axis, choose_cuts(weights, limit_, one_place_m));
    const std::vector<std::uint32_t> owner = owners(slabs, part.members);
    for (std::size_t i = 0; i < owner.size(); ++i) {
      slabs[owner[i]].members.push_back(part.members[i]);
    }
    return slabs;
  }

  void note(const Part& part, ByteCount weight) {
    found_.heaviest = Inseparable{{}, part.members[0].anchor, weight};
    for (const Anchored& anchored : part.members) {
      found_.heaviest->signatures.push_back(anchored.member->place.id);
    }
  }

  const ByteCount limit_;
  ZoneParts found_;
};

}  // namespace

ZoneParts parts_of(const Polygon& polygon, std::span<const Member> members, ByteCount limit) {
  Part whole{polygon, {}};
  for (const Member& member : members) {
    whole.members.push_back({&member, anchor_of(polygon, member.place.p_map)});
  }
  Splitter splitter(limit);
  splitter.split(std::move(whole));
  return splitter.found();
}

}  // namespace zonepack::packer
