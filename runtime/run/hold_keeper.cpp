// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/hold_keeper.hpp"

#include <algorithm>
#include <utility>

namespace zonepack {

void HoldKeeper::begin(ZoneId zone, double t_s) { open_[zone] = {.from_s = t_s}; }

void HoldKeeper::ready(ZoneId zone, double t_s) {
  if (const auto found = open_.find(zone); found != open_.end()) found->second.ready_s = t_s;
}

void HoldKeeper::end(ZoneId zone, double t_s) {
  const auto found = open_.find(zone);
  if (found == open_.end()) return;
  keep(zone, found->second, t_s);
  open_.erase(found);
}

void HoldKeeper::end_all(double t_s) {
  for (const auto& [zone, open] : open_) keep(zone, open, t_s);
  open_.clear();
}

std::vector<TraceHold> HoldKeeper::take(double t_s) {
  end_all(t_s);
  std::ranges::stable_sort(ended_, {}, &TraceHold::from_s);
  return std::exchange(ended_, {});
}

void HoldKeeper::keep(ZoneId zone, const Open& open, double t_s) {
  ended_.push_back({zone, open.from_s, open.ready_s < 0 ? t_s : open.ready_s, t_s});
  if (ended_.size() <= most_) return;
  std::ranges::stable_sort(ended_, std::greater(),
                           [](const TraceHold& hold) { return hold.to_s - hold.from_s; });
  ended_.resize(most_ / 2);
}

}  // namespace zonepack
