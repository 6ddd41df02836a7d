// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "runtime/map/catalog.hpp"
#include "runtime/protocol/messages.hpp"
#include "runtime/serve/node_store.hpp"
#include "runtime/serve/zone_activity.hpp"
#include "runtime/serve/zone_table.hpp"
#include "runtime/zones/zone_graph.hpp"

namespace zonepack {

// The map from which requests are answered. Catalog and graph belong to the run and outlive this.
struct ServedMap {
  const Catalog& catalog;
  const ZoneGraph& graph;
  std::uint32_t serial = 1;  // incremented at every change of map; never 0
  std::uint32_t epoch = 0;   // of the shared memory while it is in use; 0: there is none
  ZoneTable zones;
  ZoneActivity activity{};
  std::optional<NodeStore> nodes;  // nothing when the manifest can no longer be read

  // By number or, where one is given, by name; kNoZone when there is none.
  ZoneId find(std::uint32_t zone, const flatbuffers::String* name) const noexcept {
    if (name != nullptr) return catalog.find(view_of(name));
    return zone < catalog.zones.size() ? zone : kNoZone;
  }
};

}  // namespace zonepack
