// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/portals.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "packer/zones/near_boxes.hpp"
#include "packer/zones/plane.hpp"
#include "packer/zones/shared_border.hpp"
#include "packer/zones/zone_file.hpp"
#include "platform/base/nearest_word.hpp"
#include "runtime/pack_format/limits.hpp"

namespace zonepack::packer {
namespace {

constexpr std::size_t kMostPortalsCounted = 4096;  // of one zone, far over what is allowed

class PortalPlacer {
 public:
  PortalPlacer(const Drawing& drawing, double snap_m, ZonePlan& plan, Findings& findings)
      : snap_m_(snap_m), plan_(plan), findings_(findings) {
    for (std::uint32_t i = 0; i < plan.zones.size(); ++i) zone_at_[plan.zones[i].name] = i;
    for (const DrawnZone& drawn : drawing.zones) drawn_names_.insert(drawn.zone.name);
    for (const DrawnPortal& portal : drawing.portals) {
      if (portal.name.empty()) continue;
      first_named_.emplace(portal.name, portal.feature);
      taken_.insert(portal.name);
    }
  }

  void place(const DrawnPortal& drawn) {
    drawn_ = &drawn;
    if (!drawn.name.empty() && first_named_.at(drawn.name) != drawn.feature) {
      fault("has the name of feature " + std::to_string(first_named_.at(drawn.name)) +
            "; rename one");
    }
    bool known = true;
    for (const std::string& zone : drawn.zones) {
      if (drawn_names_.contains(zone)) continue;
      fault("names zone '" + zone + "', which is not in the file; correct the name in \"zones\"" +
            similar_name(zone));
      known = false;
    }
    if (drawn.zones[0] == drawn.zones[1]) {
      fault("joins zone '" + drawn.zones[0] + "' to itself; name the zones on its two sides");
      known = false;
    }
    if (!known) return;
    const auto a = zone_at_.find(drawn.zones[0]), b = zone_at_.find(drawn.zones[1]);
    if (a == zone_at_.end() || b == zone_at_.end()) return;  // the zone itself is faulty
    if (const auto segment = on_border(a->second, b->second)) {
      std::string name = drawn.name.empty()
                             ? fresh_portal_name(drawn.zones[0], drawn.zones[1], taken_)
                             : drawn.name;
      plan_.portals.push_back({std::move(name), a->second, b->second, *segment});
    }
  }

 private:
  void fault(const std::string& message) {
    const std::string feature = " (feature " + std::to_string(drawn_->feature) + ") ";
    const std::string subject =
        drawn_->name.empty()
            ? "portal of '" + drawn_->zones[0] + "' and '" + drawn_->zones[1] + "'" + feature
            : "portal '" + drawn_->name + "'" + feature;
    findings_.faults.push_back({drawn_->feature,
                                drawn_->line,
                                drawn_->name,
                                subject + message,
                                {{}, {drawn_->segment}, {}}});
  }

  // A name that differs in case, blanks and dashes only, else the nearest one.
  std::string similar_name(const std::string& wanted) const {
    const auto folded = [](std::string text) {
      std::erase_if(text, [](char c) { return c == ' ' || c == '-' || c == '_'; });
      for (char& c : text) {
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
      }
      return text;
    };
    for (const std::string& name : drawn_names_) {
      if (folded(name) == folded(wanted)) return " (is it '" + name + "'?)";
    }
    return known_words_text(wanted, {drawn_names_.begin(), drawn_names_.end()});
  }

  std::optional<Segment2> on_border(std::uint32_t a, std::uint32_t b) {
    const std::string pair = "'" + plan_.zones[a].name + "' and '" + plan_.zones[b].name + "'";
    const auto [known, fresh] = borders_.try_emplace({a, b});
    if (fresh) {
      known->second = shared_borders(plan_.zones[a].polygon, plan_.zones[b].polygon,
                                     2 * snap_m_ + kBorderTolerance_m, 0);
    }
    if (!known->second) {
      fault("joins " + pair + ", which share a border of more than " +
            std::to_string(kMostBorderPieces) +
            " pieces; simplify their outlines (QGIS: Vector > Geometry Tools > Simplify)");
      return std::nullopt;
    }
    const std::vector<Segment2>& border = *known->second;
    if (border.empty()) {
      fault("joins " + pair + ", which share no border: their outlines stay more than " +
            number_text(2 * snap_m_) +
            " m apart; draw the outlines up to each other, correct \"zones\", or raise --snap");
      return std::nullopt;
    }
    Segment2 moved;
    for (auto [from, to] :
         {std::pair{&drawn_->segment.p, &moved.p}, std::pair{&drawn_->segment.q, &moved.q}}) {
      *to = nearest_point(border, *from).value();
      const double off = distance_m(*from, *to);
      if (off > snap_m_ + kBorderTolerance_m) {
        fault("is off the border: its end " + point_text(*from) + " stands " + number_text(off) +
              " m off the border of " + pair + ", at most " + number_text(snap_m_) +
              " m is allowed; move it onto the border or raise --snap");
        return std::nullopt;
      }
    }
    if (distance_m(moved.p, moved.q) <= kBorderTolerance_m) {
      fault("stands across the border of " + pair + " at " + point_text(moved.p) +
            " and has no length along it; draw it along the border");
      return std::nullopt;
    }
    return moved;
  }

  const double snap_m_;
  ZonePlan& plan_;
  Findings& findings_;
  std::map<std::string, std::uint32_t> zone_at_;
  std::set<std::string> drawn_names_;
  std::map<std::string, std::size_t> first_named_;  // the first feature with each portal name
  std::set<std::string> taken_;                     // portal names
  // Of each pair of zones that a portal named so far.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::optional<std::vector<Segment2>>> borders_;
  const DrawnPortal* drawn_ = nullptr;
};

}  // namespace

void place_portals(const Drawing& drawing, double snap_m, ZonePlan& plan, Findings& findings) {
  PortalPlacer placer(drawing, snap_m, plan, findings);
  for (const DrawnPortal& portal : drawing.portals) placer.place(portal);
}

void find_portals(double snap_m, ZonePlan& plan, Findings& findings) {
  // Only zones whose boxes come near each other can share a border.
  std::vector<Box2> boxes;
  for (const PlannedZone& zone : plan.zones) boxes.push_back(bounds(zone.polygon.outer));
  NearBoxes near(std::move(boxes));
  std::set<std::string> taken;
  std::vector<std::size_t> portals(plan.zones.size());
  std::uint64_t compared = 0;
  for (std::uint32_t a = 0; a < plan.zones.size(); ++a) {
    for (const std::uint32_t b : near.after(a, snap_m, compared)) {
      const PlannedZone &zone_a = plan.zones[a], &zone_b = plan.zones[b];
      if (!share_a_height(zone_a, zone_b)) continue;
      // Faulty already, so no further portals are of use.
      if (std::max(portals[a], portals[b]) > kMostPortalsCounted) continue;
      const auto pieces = shared_borders(zone_a.polygon, zone_b.polygon, snap_m, kMinFoundPortal_m);
      if (!pieces) {
        findings.faults.push_back(
            {std::nullopt, 0, zone_a.name,
             "zones '" + zone_a.name + "' and '" + zone_b.name + "' share a border of more than " +
                 std::to_string(kMostBorderPieces) +
                 " pieces; simplify their outlines (QGIS: Vector > Geometry Tools > Simplify)"});
        continue;
      }
      for (const Segment2& piece : *pieces) {
        plan.portals.push_back({fresh_portal_name(zone_a.name, zone_b.name, taken), a, b, piece});
      }
      portals[a] += pieces->size();
      portals[b] += pieces->size();
    }
  }
  plan.portals_found = true;
}

}  // namespace zonepack::packer
