// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "runtime/evaluate/policies/least_of.hpp"
#include "runtime/evaluate/policies/orders.hpp"

namespace zonepack {
namespace {

class LfuOrder final : public EvictionOrder {
 public:
  explicit LfuOrder(std::size_t zones) : uses_(zones) {}

  void requested(ZoneId zone, bool resident) noexcept override {
    if (resident) ++uses_[zone];
  }
  void loaded(ZoneId zone, ZoneNeed) noexcept override { uses_[zone] = 1; }
  ZoneId choose(const EvictionCandidates& candidates) noexcept override {
    return least_of(candidates, [this](ZoneId zone) { return uses_[zone]; });
  }

 private:
  std::vector<std::uint64_t> uses_;  // since it became resident; by ZoneId
};

}  // namespace

std::unique_ptr<EvictionOrder> make_lfu_order(const EvictionPlace& place) {
  return std::make_unique<LfuOrder>(place.needs.size());
}

}  // namespace zonepack
