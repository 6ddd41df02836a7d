// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/policies/orders.hpp"

namespace zonepack {
namespace {

class LruOrder final : public EvictionOrder {
 public:
  ZoneId choose(const EvictionCandidates& candidates) noexcept override {
    return candidates.coldest();
  }
};

}  // namespace

std::unique_ptr<EvictionOrder> make_lru_order(const EvictionPlace&) {
  return std::make_unique<LruOrder>();
}

}  // namespace zonepack
