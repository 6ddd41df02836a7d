// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/memory/residency.hpp"
#include "runtime/run/maps/modelled_loader.hpp"
#include "runtime/zones/zone_graph.hpp"

namespace zonepack {

// A catalog in the shape in which the core takes it.
ZoneGraph graph_of(const Catalog& catalog);
std::vector<ZoneNeed> needs_of(const Catalog& catalog);

// Seconds from wish to use, by ZoneId: the load, and two cycles in which it is begun and seen.
std::vector<float> load_times_of(const std::vector<LoadWork>& work, const LoadRates& rates,
                                 std::int64_t period_ns);

// Limits for a budget. Without one: the smallest that holds any zone, any one neighbour and the
// pins, or the whole map when a limit of signatures is given, so that it alone limits, as the
// paper's MemoryThr does. lease_ns is left 0: nobody reads in a replay.
ResidencyLimits limits_for(const Catalog& catalog, std::optional<ByteCount> budget,
                           std::uint64_t max_signatures, const std::vector<ZoneId>& pinned);

// Fails when the map cannot be held within these limits, and names the zone and the smallest budget
// that would do.
Outcome<void> check_limits(const Catalog& catalog, const ResidencyLimits& limits,
                           const std::vector<ZoneId>& pinned);

// A complete warning when a zone fits, but not together with one of its neighbours: the robot will
// wait at that door.
std::optional<std::string> tightness_warning(const Catalog& catalog, const ResidencyLimits& limits,
                                             const std::vector<ZoneId>& pinned);

// What to do about a budget that is too small, as a clause.
std::string smallest_budget_text(const Catalog& catalog, const std::vector<ZoneId>& pinned);

}  // namespace zonepack
