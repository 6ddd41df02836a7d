// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/policies/eviction_names.hpp"

#include <algorithm>

#include "runtime/control/expected_use.hpp"
#include "runtime/evaluate/policies/orders.hpp"

namespace zonepack {

const std::vector<NamedEviction>& eviction_policies() {
  static const std::vector<NamedEviction> kAll = {
      {"lru", make_lru_order},
      {"fifo", make_fifo_order},
      {"lfu", make_lfu_order},
      {"gdsf", make_gdsf_order},
      {"s3-fifo", make_s3_fifo_order},
      {"sieve", make_sieve_order},
      {"expected", make_expected_use, EvictionRule::kExpected}};
  return kAll;
}

const NamedEviction* find_eviction(std::string_view name) {
  const auto& all = eviction_policies();
  const auto found = std::ranges::find(all, name, &NamedEviction::name);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace zonepack
