// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/known_route.hpp"

#include <algorithm>

namespace zonepack {

void ZonesEntered::note(const Event& event) noexcept {
  if (event.kind == EventKind::kZoneEntered && event.zone != kNoZone) {
    all_.emplace_back(event.t_ns, event.zone);
  }
}

std::vector<TimedCommand> hints_of(const ZonesEntered& zones, std::int64_t start_ns) {
  const auto& all = zones.all();
  std::vector<TimedCommand> hints;
  for (std::size_t from = 0; from < all.size(); from += Command::kMostRoute / 2) {
    TimedCommand hint;
    hint.received_ns = start_ns + (from == 0 ? 0 : all[from].first);
    hint.command.kind = Command::Kind::kRouteHint;
    const std::size_t count = std::min(all.size() - from, Command::kMostRoute);
    hint.command.route_length = static_cast<std::uint32_t>(count);
    for (std::size_t i = 0; i < count; ++i) hint.command.route[i] = all[from + i].second;
    hints.push_back(hint);
  }
  return hints;
}

}  // namespace zonepack
