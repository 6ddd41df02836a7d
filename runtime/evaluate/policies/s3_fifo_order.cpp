// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "platform/base/require.hpp"
#include "runtime/evaluate/policies/orders.hpp"

namespace zonepack {
namespace {

class S3FifoOrder final : public EvictionOrder {
 public:
  explicit S3FifoOrder(std::size_t zones)
      : links_(zones),
        ghost_links_(zones),
        small_{ZoneList(links_)},
        main_{ZoneList(links_)},
        ghost_{ZoneList(ghost_links_)},
        entries_(zones) {}

  void requested(ZoneId zone, bool resident) noexcept override {
    Entry& entry = entries_[zone];
    if (resident) {
      entry.uses = std::min(entry.uses + 1, 3);
    } else if (entry.remembered) {
      forget(zone);
      entry.returns = true;
    }
  }
  void loaded(ZoneId zone, ZoneNeed need) noexcept override {
    Entry& entry = entries_[zone];
    if (entry.remembered) {  // loaded ahead of any request
      forget(zone);
      entry.returns = true;
    }
    entry.need = need;
    entry.uses = 0;
    entry.candidate = false;
    entry.in_main = entry.returns;
    entry.returns = false;
    (entry.in_main ? main_ : small_).add(zone, need);
  }
  void released(ZoneId zone) noexcept override { entries_[zone].candidate = true; }
  void held(ZoneId zone) noexcept override { entries_[zone].candidate = false; }
  void removed(ZoneId zone) noexcept override {
    Entry& entry = entries_[zone];
    (entry.in_main ? main_ : small_).take(zone, entry.need);
    if (!entry.in_main) remember(zone);
  }
  ZoneId choose(const EvictionCandidates&) noexcept override {
    const std::uint64_t all = small_.slots() + main_.slots();
    const bool small_first = small_.count > 0 && small_.slots() * 10 >= all;
    ZoneId zone = small_first ? from_small() : from_main();
    if (zone == kNoZone) zone = small_first ? from_main() : from_small();
    // All candidates of the small queue moved to the main one.
    if (zone == kNoZone) zone = from_main();
    ZP_REQUIRE(zone != kNoZone);
    return zone;
  }

 private:
  struct Queue {
    ZoneList list;
    std::size_t count = 0;
    std::uint64_t slots() const noexcept { return list.sum().slots; }
    void add(ZoneId zone, ZoneNeed need) noexcept {
      list.append(zone, need);
      ++count;
    }
    void take(ZoneId zone, ZoneNeed need) noexcept {
      list.remove(zone, need);
      --count;
    }
  };
  struct Entry {
    ZoneNeed need;
    int uses = 0;
    bool candidate = false;
    bool in_main = false;
    bool remembered = false;  // in the ghost queue
    bool returns = false;     // was, when it was requested
  };

  ZoneId from_small() noexcept {
    for (ZoneId zone = small_.list.coldest(); zone != kNoZone;) {
      const ZoneId next = small_.list.warmer(zone);
      Entry& entry = entries_[zone];
      if (entry.candidate) {
        if (entry.uses <= 1) return zone;
        small_.take(zone, entry.need);
        main_.add(zone, entry.need);
        entry.in_main = true;
      }
      zone = next;
    }
    return kNoZone;
  }

  // A candidate has at most three uses, so each comes by at most four times.
  ZoneId from_main() noexcept {
    std::size_t looks = 4 * main_.count;
    for (ZoneId zone = main_.list.coldest(); zone != kNoZone && looks > 0; --looks) {
      const ZoneId next = main_.list.warmer(zone);
      Entry& entry = entries_[zone];
      if (entry.candidate) {
        if (entry.uses == 0) return zone;
        --entry.uses;
        main_.take(zone, entry.need);
        main_.add(zone, entry.need);
      }
      zone = next != kNoZone ? next : main_.list.coldest();
    }
    return kNoZone;
  }

  void remember(ZoneId zone) noexcept {
    ghost_.add(zone, {});
    entries_[zone].remembered = true;
    while (ghost_.count > std::max<std::size_t>(main_.count, 1)) forget(ghost_.list.coldest());
  }
  void forget(ZoneId zone) noexcept {
    ghost_.take(zone, {});
    entries_[zone].remembered = false;
  }

  std::vector<ZoneLink> links_;        // a zone is in the small or the main queue
  std::vector<ZoneLink> ghost_links_;  // or, when it is not resident, in the ghost queue
  Queue small_, main_, ghost_;         // the oldest is the coldest
  std::vector<Entry> entries_;         // by ZoneId
};

}  // namespace

std::unique_ptr<EvictionOrder> make_s3_fifo_order(const EvictionPlace& place) {
  return std::make_unique<S3FifoOrder>(place.needs.size());
}

}  // namespace zonepack
