// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "runtime/map/catalog.hpp"
#include "runtime/memory/arena.hpp"

// What the benchmarks of loading share.
namespace zonepack::bench {

[[noreturn]] inline void fail(const std::string& what) { throw std::runtime_error(what); }

inline Catalog open_map(const std::string& folder, PayloadMask payload) {
  auto catalog = Catalog::open(folder, payload);
  if (!catalog) fail(folder + ": no map: " + catalog.error().message);
  return std::move(*catalog);
}

inline std::uint32_t most_slots(const Catalog& catalog) {
  std::uint32_t most = 1;
  for (const CatalogZone& zone : catalog.zones) most = std::max(most, zone.slots);
  return most;
}

// A map, and memory for its largest zone.
struct BenchMap {
  BenchMap(const std::string& folder, PayloadMask payload)
      : catalog(open_map(folder, payload)), arena(most_slots(catalog), kSlotBytes) {
    for (SlotIndex i = 0; i < arena.slot_count(); ++i) slots.push_back(arena.slot(i).data());
  }

  const Catalog catalog;
  Arena arena;
  std::vector<std::byte*> slots;
};

}  // namespace zonepack::bench
