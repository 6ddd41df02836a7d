// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/control/eviction_rule.hpp"
#include "runtime/memory/eviction_order.hpp"

namespace zonepack {

struct NamedEviction {
  std::string_view name;
  EvictionOrderMaker make;
  EvictionRule rule = EvictionRule::kLru;  // by which the robot's tables are charged
};

// All that `zoned evaluate --eviction` knows, in the order in which they are shown; lru first.
const std::vector<NamedEviction>& eviction_policies();

// Null: no such policy.
const NamedEviction* find_eviction(std::string_view name);

}  // namespace zonepack
