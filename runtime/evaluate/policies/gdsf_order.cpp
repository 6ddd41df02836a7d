// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "runtime/evaluate/policies/least_of.hpp"
#include "runtime/evaluate/policies/orders.hpp"

namespace zonepack {
namespace {

class GdsfOrder final : public EvictionOrder {
 public:
  explicit GdsfOrder(std::span<const ZoneNeed> needs) : needs_(needs), entries_(needs.size()) {}

  void requested(ZoneId zone, bool resident) noexcept override {
    if (!resident) return;
    ++entries_[zone].uses;
    rank(zone);
  }
  void loaded(ZoneId zone, ZoneNeed) noexcept override {
    entries_[zone].uses = 1;
    rank(zone);
  }
  ZoneId choose(const EvictionCandidates& candidates) noexcept override {
    const ZoneId zone =
        least_of(candidates, [this](ZoneId other) { return entries_[other].priority; });
    age_ = entries_[zone].priority;
    return zone;
  }

 private:
  struct Entry {
    std::uint64_t uses = 0;
    std::uint64_t priority = 0;  // in units of 1 / kOne uses a slot
  };
  static constexpr std::uint64_t kOne = std::uint64_t{1} << 24;

  void rank(ZoneId zone) noexcept {
    const std::uint64_t slots = std::max<std::uint64_t>(needs_[zone].slots, 1);
    entries_[zone].priority = age_ + entries_[zone].uses * kOne / slots;
  }

  std::span<const ZoneNeed> needs_;
  std::vector<Entry> entries_;  // by ZoneId
  std::uint64_t age_ = 0;
};

}  // namespace

std::unique_ptr<EvictionOrder> make_gdsf_order(const EvictionPlace& place) {
  return std::make_unique<GdsfOrder>(place.needs);
}

}  // namespace zonepack
