// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/pack_format/file/accounting.hpp"

namespace zonepack::packer {

struct ZoneCost {
  std::string name;
  std::string layer;  // empty: none
  std::uint32_t signatures = 0;
  std::uint32_t slots = 0;
  ByteCount charged_bytes = 0;  // slots x slot size
  ByteCount stored_bytes = 0;   // read for the payload
  bool pinned = false;
  bool loaded = true;  // false: of a layer that is not chosen; it charges nothing
};

// What one budget allows while the pinned zones are always held.
struct BudgetPlan {
  ByteCount bytes = 0;
  bool suffices = false;                     // not below the smallest budget
  std::uint64_t slots = 0;                   // that the budget covers
  std::vector<ZoneId> zones_without_room;    // even alone besides the pinned ones
  std::vector<ZonePair> pairs_without_room;  // neighbours of which each fits alone
  std::size_t largest_zones_at_once = 0;     // so many fit together, whichever they are
  bool whole_map = false;                    // nothing is ever evicted
};

// What a map costs by the runtime's own accounting (runtime/pack_format/file/accounting.hpp):
//
//   smallest    = fixed + (pinned + largest pair of neighbours) x (slot + its tables)
//   live change = smallest + fixed + largest zone x (slot + its tables)
//
// fixed: tables, manifest, zone graph, read buffers. While a map changes, the tables of both exist,
// and the robot's zone of the new map is loaded besides the pair and the pins of the old one. The
// new map is assumed to be as large as this one.
struct MapPlan {
  PayloadMask payload = 0;
  ByteCount fixed_bytes = 0;
  ByteCount transitions_bytes = 0;  // that a robot with preload.transitions takes in addition
  SmallestBudget smallest;
  ByteCount live_change_bytes = 0;
  std::vector<ZoneCost> zones;  // by ZoneId
  std::optional<BudgetPlan> budget;
};

// `file_bytes`: of the manifest's file, which count from some hundred kilobytes on
// (accounting.hpp). `layers`: zones of others are not loaded, as memory.layers says; empty: all
// are.
MapPlan plan_map(const fb::Manifest& manifest, PayloadMask payload, std::span<const ZoneId> pinned,
                 std::optional<ByteCount> budget, ByteCount file_bytes = 0,
                 const std::vector<std::string>& layers = {});

}  // namespace zonepack::packer
