// SPDX-License-Identifier: Apache-2.0
#include "packer/update/zone_contents.hpp"

#include <algorithm>
#include <stdexcept>

#include "packer/update/held_plan.hpp"
#include "packer/zones/findings.hpp"
#include "packer/zones/redrawn.hpp"

namespace zonepack::packer {
namespace {

// The zones that --replace names, parts of a split one each by itself.
std::set<std::string> replaced_zones(const MapReader& map,
                                     const std::vector<std::string>& replace) {
  std::set<std::string> names;
  for (const std::string& name : replace) {
    for (const ZoneId zone : map.zones_named(name)) {
      names.insert(map.manifest().zones()->Get(zone)->name()->str());
    }
  }
  return names;
}

void say_left_out(const UpdateOptions& options, UpdateSummary& summary) {
  if (summary.left_out.empty()) return;
  std::size_t count = 0;
  std::string zones;
  constexpr std::size_t kShown = 8;
  std::size_t shown = 0;
  for (const auto& [zone, signatures] : summary.left_out) {
    count += signatures;
    if (shown++ < kShown) {
      zones += (zones.empty() ? "" : ", ") + zone + ": " + std::to_string(signatures);
    }
  }
  if (shown > kShown) zones += " and " + std::to_string(shown - kShown) + " zones more";
  summary.warnings.push_back(
      options.source.name() + ": " + std::to_string(count) +
      (count == 1 ? " signature that the map lacks stands"
                  : " signatures that the map lacks stand") +
      " in zones that stay as they are (" + zones + "); left out. Take them with --replace ZONE" +
      (options.zones.empty() && options.add ? "" : ", or all with --add and no --zones"));
}

}  // namespace

std::uint32_t index_of(const ZonePlan& plan, const std::string& name) {
  const auto found = std::ranges::lower_bound(plan.zones, name, {}, &PlannedZone::name);
  if (found == plan.zones.end() || found->name != name) return ZoneContents::kNone;
  return static_cast<std::uint32_t>(found - plan.zones.begin());
}

ZoneContents::ZoneContents(const MapReader& map, const UpdateOptions& options, double snap_m,
                           UpdateSummary& summary)
    : options_(options), before_(plan_of(map.manifest())) {
  const std::set<std::string> replaced_names = replaced_zones(map, options.replace);
  for (const fb::Zone* zone : *map.manifest().zones()) {
    signatures_before_.push_back(zone->signatures());
  }
  if (options_.zones.empty()) {
    plan_ = before_;
  } else {
    Redrawn redrawn = options_.add ? add_zones(before_, options_.zones.string(), snap_m)
                                   : redraw(before_, options_.zones.string(), snap_m,
                                            {options_.replace.begin(), options_.replace.end()});
    plan_ = std::move(redrawn.plan);
    fresh_ = std::move(redrawn.fresh);
    summary.warnings = std::move(redrawn.warnings);
    for (const std::string& name : redrawn.not_taken) {
      summary.warnings.push_back(options_.zones.string() + ": zone '" + name +
                                 "' is not in the map and not taken; add it with --add");
    }
  }
  contents_.resize(plan_.zones.size());
  place_of_held_.assign(before_.zones.size(), kNone);
  for (std::uint32_t zone = 0; zone < plan_.zones.size(); ++zone) {
    const std::string& name = plan_.zones[zone].name;
    const std::uint32_t held = index_of(before_, name);
    Content& content = contents_[zone];
    const bool replaced = replaced_names.contains(name) || (!options_.add && fresh_.contains(name));
    if (held != kNone && !replaced) {
      content.held = held;
      place_of_held_[held] = zone;
    }
    content.takes_newcomers = options_.add ? fresh_.empty() || fresh_.contains(name) : replaced;
    content.packed = content.held == kNone;
  }
}

void ZoneContents::choose(const HeldSignatures& held, const Newcomers* newcomers,
                          OrphanPolicy policy, UpdateSummary& summary) {
  for (const auto& [id, signature] : held.by_id()) {
    const std::uint32_t zone = place_of_held_[signature.zone];
    if (zone == kNone || !options_.sessions.dropped.contains(signature.session)) continue;
    contents_[zone].packed = true;
  }
  if (newcomers != nullptr) give_newcomers(held, *newcomers, policy, summary);
  say_left_out(options_, summary);
}

void ZoneContents::give_newcomers(const HeldSignatures& held, const Newcomers& newcomers,
                                  OrphanPolicy policy, UpdateSummary& summary) {
  // Whether the map holds this very signature, in a zone that keeps it.
  const auto stays = [&](const Newcomer& newcomer) {
    return newcomer.held && place_of_held_[held.find(newcomer.id)->zone] != kNone;
  };
  std::vector<const Newcomer*> orphans;
  for (const Newcomer& newcomer : newcomers.all()) {
    if (stays(newcomer)) continue;
    Content& content = contents_[newcomer.zone];
    if (!content.takes_newcomers) {
      ++summary.left_out[plan_.zones[newcomer.zone].name];
      continue;
    }
    if (newcomer.orphan) {
      orphans.push_back(&newcomer);
      if (policy == OrphanPolicy::kDrop) continue;
    }
    content.newcomers.push_back(&newcomer);
    content.packed = true;
    taken_.insert(newcomer.id);
  }
  summary.orphans = orphans.size();
  if (policy == OrphanPolicy::kError && !orphans.empty()) refuse_orphans(orphans);
  refuse_empty();
}

void ZoneContents::refuse_orphans(const std::vector<const Newcomer*>& orphans) const {
  const Newcomer& first = *orphans.front();
  throw std::runtime_error(
      options_.source.name() + ": " + std::to_string(orphans.size()) +
      (orphans.size() == 1 ? " signature stands" : " signatures stand") +
      " in no zone, nearest to a zone of this update, such as " + std::to_string(first.node->id) +
      " at " + point_text({first.T_map_base[3], first.T_map_base[7]}) +
      "; draw the zones so that they hold them, or update with --orphans nearest or drop");
}

// A zone that would lose all that it has is more often a wrong frame than a wish.
void ZoneContents::refuse_empty() const {
  for (std::uint32_t zone = 0; zone < contents_.size(); ++zone) {
    const std::string& name = plan_.zones[zone].name;
    const bool replaced = contents_[zone].takes_newcomers && !options_.add;
    if (!replaced || !contents_[zone].newcomers.empty()) continue;
    const std::uint32_t before = index_of(before_, name);
    if (before != kNone && signatures_before_[before] == 0) continue;
    throw std::runtime_error(options_.source.name() + ": no signature stands in zone " + name +
                             ", which would lose all it has; is the database in the map's frame? "
                             "If not, give --align a trajectory of its signatures there");
  }
}

}  // namespace zonepack::packer
