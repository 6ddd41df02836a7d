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

// The bound by one limit: `size_of` a zone, `room` for all.
template <typename SizeOf, typename CostOf>
std::uint64_t least_cost(const RequestSteps& requests, const BoundPlace& place, std::uint64_t room,
                         SizeOf&& size_of, CostOf&& cost_of) {
  std::vector<std::uint64_t> free;
  for (const std::vector<ZoneId>& step : requests.steps) {
    std::uint64_t needed = 0;
    for (const ZoneId zone : step) needed += size_of(place.zones[zone]);
    ZP_REQUIRE(needed <= room);
    free.push_back(room - needed);
  }
  std::uint64_t all = 0;
  std::vector<Interval> gaps;
  const auto uses = uses_of(requests, place.zones.size());
  for (std::size_t zone = 0; zone < uses.size(); ++zone) {
    const ZoneWeight& weight = place.zones[zone];
    all += uses[zone].size() * cost_of(weight);
    for (std::size_t i = 1; i < uses[zone].size(); ++i) {
      gaps.push_back({uses[zone][i - 1] + 1, uses[zone][i] - 1, size_of(weight), cost_of(weight)});
    }
  }
  return all - most_gain(free, gaps);
}

template <typename CostOf>
std::uint64_t least_cost(const RequestSteps& requests, const BoundPlace& place, CostOf&& cost_of) {
  const std::uint64_t by_slots = least_cost(
      requests, place, place.slots, [](const ZoneWeight& zone) { return zone.need.slots; },
      cost_of);
  if (place.signatures == 0) return by_slots;
  return std::max(by_slots,
                  least_cost(
                      requests, place, place.signatures,
                      [](const ZoneWeight& zone) { return zone.need.signatures; }, cost_of));
}

}  // namespace

LoadTotals evict_farthest(const RequestSteps& requests, const BoundPlace& place) {
  return FarthestRun(requests, place).run();
}

LoadTotals least_loads(const RequestSteps& requests, const BoundPlace& place) {
  return {least_cost(requests, place, [](const ZoneWeight&) { return std::uint64_t{1}; }),
          least_cost(requests, place,
                     [](const ZoneWeight& zone) { return std::uint64_t{zone.need.signatures}; }),
          least_cost(requests, place, [](const ZoneWeight& zone) { return zone.stored_bytes; })};
}

}  // namespace zonepack
