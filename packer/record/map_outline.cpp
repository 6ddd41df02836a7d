// SPDX-License-Identifier: Apache-2.0
#include "packer/record/map_outline.hpp"

#include <algorithm>
#include <stdexcept>

namespace zonepack::packer {

const NodeOutline* MapOutline::find(std::int32_t id) const noexcept {
  const auto found =
      std::lower_bound(nodes.begin(), nodes.end(), id,
                       [](const NodeOutline& node, std::int32_t key) { return node.id < key; });
  return found != nodes.end() && found->id == id ? &*found : nullptr;
}

std::size_t MapOutline::unlinked() const noexcept {
  std::size_t count = 0;
  for (const auto& [session, nodes_without_pose] : unlinked_by_session) count += nodes_without_pose;
  return count;
}

std::optional<std::string> MapOutline::parameter(std::string_view key) const {
  std::string_view rest = parameters;
  while (!rest.empty()) {
    const std::string_view entry = rest.substr(0, rest.find(';'));
    rest.remove_prefix(std::min(rest.size(), entry.size() + 1));
    const std::size_t colon = entry.find(':');
    if (colon != std::string_view::npos && entry.substr(0, colon) == key) {
      return std::string(entry.substr(colon + 1));
    }
  }
  return std::nullopt;
}

void require_signatures(const MapOutline& outline, const std::string& database) {
  if (!outline.nodes.empty()) return;
  throw std::runtime_error(database +
                           ": the database holds no signatures; nothing to pack. Map the building "
                           "again and let " +
                           (outline.kind == "rtabmap" ? "RTAB-Map close the database"
                                                      : "the program save the map at its end"));
}

}  // namespace zonepack::packer
