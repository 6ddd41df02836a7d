// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/memory/eviction_order.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack {

// What an eviction order was told and what it chose, for a check by other code. As CSV:
//
//   t_ns,op,zone,slots,signatures
//
// in the order in which it happened. t_ns: the cycle's, since the first one. zone: its name, quoted
// as RFC 4180 has it where it holds a comma, a quote or a line feed. op: requested, loaded (with
// what the zone takes), released, held, removed as EvictionOrder says, and evicted: the order chose
// this zone, of those released and not held; removed follows.
class OrderTrace {
 public:
  enum class Op : std::uint8_t { kRequested, kLoaded, kReleased, kHeld, kRemoved, kEvicted };
  struct Row {
    std::int64_t t_ns;
    Op op;
    ZoneId zone;
    ZoneNeed need;
  };

  void add(std::int64_t t_ns, Op op, ZoneId zone, ZoneNeed need = {}) {
    if (rows_.empty()) first_ns_ = t_ns;
    rows_.push_back({t_ns - first_ns_, op, zone, need});
  }
  std::string csv(std::span<const std::string> zone_names) const;

 private:
  std::int64_t first_ns_ = 0;
  std::vector<Row> rows_;
};

// The same order, which writes to the trace; that outlives it.
std::unique_ptr<EvictionOrder> traced(std::unique_ptr<EvictionOrder> order, OrderTrace& trace);

}  // namespace zonepack
