// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/bounds.hpp"

#include <algorithm>
#include <limits>

#include "platform/base/require.hpp"
#include "runtime/evaluate/interval_packing.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

bool fits(const NeedSum& held, ZoneNeed more, const BoundPlace& place) {
  return held.slots + more.slots <= place.slots &&
         (place.signatures == 0 || held.signatures + more.signatures <= place.signatures);
}

// By zone: the steps that need it, ascending.
std::vector<std::vector<std::size_t>> uses_of(const RequestSteps& requests, std::size_t zones) {
  std::vector<std::vector<std::size_t>> uses(zones);
  for (std::size_t step = 0; step < requests.steps.size(); ++step) {
    for (const ZoneId zone : requests.steps[step]) uses[zone].push_back(step);
  }
  return uses;
}

class FarthestRun {
 public:
  FarthestRun(const RequestSteps& requests, const BoundPlace& place)
      : requests_(requests),
        place_(place),
        uses_(uses_of(requests, place.zones.size())),
        used_(uses_.size()),
        resident_(uses_.size()),
        needed_(uses_.size()) {}

  LoadTotals run() {
    for (const std::vector<ZoneId>& step : requests_.steps) {
      for (const ZoneId zone : step) needed_[zone] = true;
      for (const ZoneId zone : step) {
        if (!resident_[zone]) load(zone);
        ++used_[zone];
      }
      for (const ZoneId zone : step) needed_[zone] = false;
    }
    return totals_;
  }

 private:
  void load(ZoneId zone) {
    const ZoneWeight& weight = place_.zones[zone];
    while (!fits(held_, weight.need, place_)) evict_one();
    held_.add(weight.need);
    resident_[zone] = true;
    ++totals_.loads;
    totals_.signatures += weight.need.signatures;
    totals_.bytes += weight.stored_bytes;
  }

  void evict_one() {
    ZoneId farthest = kNoZone;
    std::size_t latest = 0;
    for (ZoneId zone = 0; zone < resident_.size(); ++zone) {
      if (!resident_[zone] || needed_[zone]) continue;
      const std::size_t next = used_[zone] < uses_[zone].size() ? uses_[zone][used_[zone]] : kNever;
      if (farthest != kNoZone && next <= latest) continue;
      farthest = zone;
      latest = next;
    }
    ZP_REQUIRE(farthest != kNoZone);  // the zones of a step fit together, as they did in the run
    resident_[farthest] = false;
    held_.remove(place_.zones[farthest].need);
  }

  const RequestSteps& requests_;
  const BoundPlace& place_;
  std::vector<std::vector<std::size_t>> uses_;
  std::vector<std::size_t> used_;  // uses so far, by zone
  std::vector<bool> resident_, needed_;
  NeedSum held_;
  LoadTotals totals_;
};

// A stretch between two steps that need a zone, and what the steps inside leave free.
class Gaps {
 public:
  Gaps(const RequestSteps& requests, const BoundPlace& place) : place_(place) {
    for (const std::vector<ZoneId>& step : requests.steps) {
      NeedSum needed;
      for (const ZoneId zone : step) needed.add(place.zones[zone].need);
      ZP_REQUIRE(fits(needed, {}, place));
      needed_.push_back(needed);
    }
    const auto uses = uses_of(requests, place.zones.size());
    for (ZoneId zone = 0; zone < uses.size(); ++zone) {
      for (std::size_t i = 0; i < uses[zone].size(); ++i) {
        uses_.push_back(zone);
        if (i > 0) add(zone, uses[zone][i - 1] + 1, uses[zone][i] - 1);
      }
    }
  }

  // The bound that one limit gives: `room` for all, of which a need takes size_of(need).
  template <typename SizeOf, typename CostOf>
  std::uint64_t least_cost(std::uint64_t room, SizeOf&& size_of, CostOf&& cost_of) const {
    std::vector<std::uint64_t> free;
    for (const NeedSum& needed : needed_) free.push_back(room - size_of(needed));
    std::uint64_t all = 0;
    for (const ZoneId zone : uses_) all += cost_of(place_.zones[zone]);
    std::vector<Interval> intervals;
    for (const Gap& gap : gaps_) {
      const ZoneWeight& zone = place_.zones[gap.zone];
      intervals.push_back({gap.first, gap.last, size_of(zone.need), cost_of(zone)});
    }
    return all - most_gain(free, intervals);
  }

 private:
  struct Gap {
    ZoneId zone;
    std::size_t first, last;  // steps inside; none: last < first
  };

  // Unless the zone does not fit next to what some step inside needs.
  void add(ZoneId zone, std::size_t first, std::size_t last) {
    for (std::size_t step = first; step <= last && step < needed_.size(); ++step) {
      if (!fits(needed_[step], place_.zones[zone].need, place_)) return;
    }
    gaps_.push_back({zone, first, last});
  }

  const BoundPlace& place_;
  std::vector<NeedSum> needed_;  // by step
  std::vector<ZoneId> uses_;     // a zone for each step that needs it
  std::vector<Gap> gaps_;        // that could be kept
};

template <typename CostOf>
std::uint64_t least_cost(const Gaps& gaps, const BoundPlace& place, CostOf&& cost_of) {
  const std::uint64_t by_slots = gaps.least_cost(
      place.slots, [](const auto& need) { return std::uint64_t{need.slots}; }, cost_of);
  if (place.signatures == 0) return by_slots;
  return std::max(by_slots,
                  gaps.least_cost(
                      place.signatures,
                      [](const auto& need) { return std::uint64_t{need.signatures}; }, cost_of));
}

}  // namespace

LoadTotals evict_farthest(const RequestSteps& requests, const BoundPlace& place) {
  return FarthestRun(requests, place).run();
}

LoadTotals least_loads(const RequestSteps& requests, const BoundPlace& place) {
  const Gaps gaps(requests, place);
  return {least_cost(gaps, place, [](const ZoneWeight&) { return std::uint64_t{1}; }),
          least_cost(gaps, place,
                     [](const ZoneWeight& zone) { return std::uint64_t{zone.need.signatures}; }),
          least_cost(gaps, place,
                     [](const ZoneWeight& zone) { return std::uint64_t{zone.stored_bytes}; })};
}

}  // namespace zonepack
