// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "platform/base/require.hpp"
#include "runtime/evaluate/policies/orders.hpp"

namespace zonepack {
namespace {

class SieveOrder final : public EvictionOrder {
 public:
  explicit SieveOrder(std::size_t zones) : links_(zones), queue_(links_), entries_(zones) {}

  void requested(ZoneId zone, bool resident) noexcept override {
    if (resident) entries_[zone].used = true;
  }
  void loaded(ZoneId zone, ZoneNeed) noexcept override {
    queue_.append(zone, {});
    ++count_;
    entries_[zone] = {};
  }
  void released(ZoneId zone) noexcept override { entries_[zone].candidate = true; }
  void held(ZoneId zone) noexcept override { entries_[zone].candidate = false; }
  void removed(ZoneId zone) noexcept override {
    if (hand_ == zone) hand_ = queue_.warmer(zone);
    queue_.remove(zone, {});
    --count_;
  }
  ZoneId choose(const EvictionCandidates&) noexcept override {
    // Once around clears every mark of a candidate; twice finds one without.
    for (std::size_t looks = 0; looks < 3 * count_; ++looks) {
      const ZoneId zone = hand_ != kNoZone ? hand_ : queue_.coldest();
      if (entries_[zone].candidate && !entries_[zone].used) {
        hand_ = zone;  // removed() moves it on
        return zone;
      }
      if (entries_[zone].candidate) entries_[zone].used = false;
      hand_ = queue_.warmer(zone);
    }
    ZP_REQUIRE(false);
    return kNoZone;
  }

 private:
  struct Entry {
    bool used = false;
    bool candidate = false;
  };

  std::vector<ZoneLink> links_;
  ZoneList queue_;  // all resident zones, the oldest coldest
  std::vector<Entry> entries_;
  std::size_t count_ = 0;
  ZoneId hand_ = kNoZone;  // none: at the oldest
};

}  // namespace

std::unique_ptr<EvictionOrder> make_sieve_order(const EvictionPlace& place) {
  return std::make_unique<SieveOrder>(place.needs.size());
}

}  // namespace zonepack
