// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/control/eviction_rule.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/memory/residency.hpp"
#include "runtime/run/maps/modelled_loader.hpp"
#include "runtime/zones/transitions_file.hpp"
#include "runtime/zones/zone_graph.hpp"

namespace zonepack {

// How a map is to be held.
struct MapTerms {
  std::optional<ByteCount> budget{};  // nothing: see limits_for(), but never over default_most
  ByteCount default_most = Catalog::kNoMost;
  std::uint64_t max_signatures = 0;
  std::vector<std::string> pinned{};  // names
  LoadRates rates{};
  std::int64_t period_ns = 10'000'000;
  std::int64_t lease_ns = 0;
  std::optional<std::uint32_t> slots{};  // that there are; nothing: as many as are of use
  bool habits = false;  // a table of Transitions is held, with what was learned, unless null
  std::shared_ptr<const LearnedTransitions> learned{};
  EvictionRule eviction = EvictionRule::kLru;
};

// What holding a map on these terms takes besides what the catalog charges.
ByteCount extra_fixed_bytes(const Catalog& catalog, const MapTerms& terms);
// The catalog with these charged.
Catalog charged_on(Catalog catalog, const MapTerms& terms);

// A map in the shape in which the cycle takes it, with the limits to hold. Immutable; the catalog
// must outlive it.
struct MapModel {
  const Catalog& catalog;
  std::vector<ZoneId> pinned;
  ResidencyLimits limits;
  ZoneGraph graph;
  std::vector<ZoneNeed> needs;
  std::vector<float> load_s;
  // To reserve: as many as all zones fill together, and another version's largest in addition; less
  // where the budget must also hold long tables of another version.
  std::uint32_t slots;
  std::optional<std::string> warning;  // a complete message

  // Fails when the map cannot be held on these terms.
  static Outcome<std::unique_ptr<MapModel>> make(const Catalog& catalog, const MapTerms& terms);

  // What reading another version's manifest and holding its tables may take while this map is in
  // memory: what the budget leaves, and what the program's own memory allows for.
  ByteCount room_for_next() const noexcept;

  // How another version of the map is to be held in this one's place: no more of anything.
  MapTerms terms_of_next(const MapTerms& terms) const;

  // Pins what is to be pinned in a new Residency.
  Outcome<void> pin(Residency& memory) const;
};

}  // namespace zonepack
