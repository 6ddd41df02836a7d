// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/map/catalog.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack::localize {

// The order in which a lost robot's zones are tried: the last known one, then door by door from
// there, nearer ones first; without a last one from the zone with most signatures, where a robot is
// most often. Zones that no door leads to come last. Each zone once.
std::vector<ZoneId> search_order(const Catalog& map, ZoneId last);

}  // namespace zonepack::localize
