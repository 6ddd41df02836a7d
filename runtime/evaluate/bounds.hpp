// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "runtime/memory/zone_list.hpp"
#include "runtime/pack_format/ids.hpp"

// What any choice of whom to evict could have loaded at best on the requests of one run.
//
// A run's requests are steps in time; at each, some zones took memory and were in use: the robot's
// own, those being approached, those pinned. Loads that the run gave up are not requests. Whatever
// is kept between the steps, by whatever rule, and with whatever knowledge, it holds the zones of
// each step at that step, and never more than there is room for.
namespace zonepack {

struct RequestSteps {
  std::vector<std::vector<ZoneId>> steps;  // each without doubles
};

struct ZoneWeight {
  ZoneNeed need;
  ByteCount stored_bytes = 0;
};

struct BoundPlace {
  std::span<const ZoneWeight> zones;  // by ZoneId
  std::uint64_t slots = 0;
  std::uint64_t signatures = 0;  // 0: no limit
};

struct LoadTotals {
  std::uint64_t loads = 0;
  std::uint64_t signatures = 0;
  ByteCount bytes = 0;  // read from storage
  friend bool operator==(const LoadTotals&, const LoadTotals&) = default;
};

// Loads a zone at the step that needs it, and evicts the zones next needed farthest ahead (of
// several the one with the lowest ZoneId) until it fits: feasible, and with zones of one size the
// least there can be (Belady). With sizes it need not be.
LoadTotals evict_farthest(const RequestSteps& requests, const BoundPlace& place);

// What nobody can go below, in each number by itself.
//
// Proof. Between two steps that need a zone with none between them that does, the zone either stays
// in memory for all of that gap, or is loaded again: each need costs a load unless the gap before
// it is kept, and a first need always costs one. So loads = needs - gaps kept, weighted by what a
// load of the zone costs. A kept gap takes the zone's room at each step inside it, next to the
// zones that the step itself needs; a zone that does not fit next to these at one of the steps
// cannot be kept. So the gaps kept by any rule are a set of intervals that fits into what each step
// leaves free, and the cost is at least that of all needs less the most that such a set can gain;
// most_gain() is no less than this. With a limit of signatures as well, each of the two limits
// alone gives a bound, and the larger one holds.
LoadTotals least_loads(const RequestSteps& requests, const BoundPlace& place);

}  // namespace zonepack
