// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "runtime/pack_format/file/geometry.hpp"
#include "runtime/pack_format/ids.hpp"
#include "runtime/zones/box_tree.hpp"

namespace zonepack {

struct GraphZone {
  std::string name;
  Polygon polygon;
  bool loadable = true;  // false: of a layer that is not used; never loaded
};

struct GraphPortal {
  ZoneId zone_a = kNoZone;
  ZoneId zone_b = kNoZone;
  Segment2 segment;
};

// A portal as seen from one of its zones.
struct Exit {
  ZoneId to = kNoZone;
  Segment2 segment;
  Point2 outward;  // unit vector across the segment, towards `to`; zero for a segment of no length
};

// Where zones are and where one can pass between them. Metres in the map frame.
//
// Zones come sorted by name, so the lowest ZoneId is the first by name. Zones and portals respect
// the limits of the format (kMaxVerticesPerZone, kMaxPortalsPerZone), which bound every call here.
// Real-time: no allocation after construction; every call costs O(log zones) plus the vertices of
// the zones around the point.
// Threads: immutable.
class ZoneGraph {
 public:
  ZoneGraph(std::vector<GraphZone> zones, std::span<const GraphPortal> portals);

  std::size_t zone_count() const noexcept { return zones_.size(); }
  const std::string& name(ZoneId zone) const noexcept { return zones_[zone].name; }
  const Polygon& polygon(ZoneId zone) const noexcept { return zones_[zone].polygon; }

  bool loadable(ZoneId zone) const noexcept { return zones_[zone].loadable; }

  // The zone of this name; kNoZone: none.
  ZoneId find(std::string_view name) const noexcept;

  // The portals of a zone, in the order in which they were given.
  std::span<const Exit> exits(ZoneId zone) const noexcept;

  // All exits are numbered, those of the first zone first. first_exit(): the number of a zone's
  // first one; of zone_count(): how many there are. zone_of_exit(): whose a number is.
  std::uint32_t first_exit(ZoneId zone) const noexcept { return first_exit_[zone]; }
  ZoneId zone_of_exit(std::uint32_t number) const noexcept;

  // The zone that holds the point, as the packer assigns signatures: inside takes precedence over
  // on the border, then the lowest ZoneId; kNoZone outside of all.
  ZoneId zone_at(Point2 point) const noexcept;

  // zone_at, or else the nearest zone within `radius_m`.
  ZoneId zone_near(Point2 point, double radius_m) const noexcept;

  // How far inside the zone the point lies: metres to its border, negative outside.
  double depth_m(ZoneId zone, Point2 point) const noexcept;

  // What the graph takes from the budget: everything it allocated.
  ByteCount memory_bytes() const noexcept;

 private:
  Point2 direction_into(ZoneId zone, const Segment2& portal) const noexcept;

  std::vector<GraphZone> zones_;
  std::vector<std::uint32_t> first_exit_;  // of each zone, and the end
  std::vector<Exit> exits_;
  BoxTree boxes_;
};

}  // namespace zonepack
