// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "runtime/evaluate/policies/least_of.hpp"
#include "runtime/evaluate/policies/orders.hpp"

namespace zonepack {
namespace {

class FifoOrder final : public EvictionOrder {
 public:
  explicit FifoOrder(std::size_t zones) : loaded_(zones) {}

  void loaded(ZoneId zone, ZoneNeed) noexcept override { loaded_[zone] = ++loads_; }
  ZoneId choose(const EvictionCandidates& candidates) noexcept override {
    return least_of(candidates, [this](ZoneId zone) { return loaded_[zone]; });
  }

 private:
  std::vector<std::uint64_t> loaded_;  // when, by the number of loads; by ZoneId
  std::uint64_t loads_ = 0;
};

}  // namespace

std::unique_ptr<EvictionOrder> make_fifo_order(const EvictionPlace& place) {
  return std::make_unique<FifoOrder>(place.needs.size());
}

}  // namespace zonepack
