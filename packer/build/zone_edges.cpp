// SPDX-License-Identifier: Apache-2.0
#include "packer/build/zone_edges.hpp"

#include <algorithm>

namespace zonepack::packer {

ZoneEdges::ZoneEdges(const std::vector<std::vector<fb::Node>>& nodes) {
  for (std::uint32_t zone = 0; zone < nodes.size(); ++zone) {
    for (const fb::Node& node : nodes[zone]) zone_of_[node.id()] = zone;
  }
}

std::optional<std::pair<std::uint32_t, std::uint32_t>> ZoneEdges::add(std::int32_t from,
                                                                      std::int32_t to) {
  const auto a = zone_of_.find(from), b = zone_of_.find(to);
  if (a == zone_of_.end() || b == zone_of_.end() || a->second == b->second) return std::nullopt;
  ++counts_[std::minmax(a->second, b->second)];
  return std::pair(a->second, b->second);
}

std::vector<fb::ZoneEdge> ZoneEdges::list() const {
  std::vector<fb::ZoneEdge> edges;
  edges.reserve(counts_.size());
  for (const auto& [pair, links] : counts_) edges.emplace_back(pair.first, pair.second, links);
  return edges;
}

}  // namespace zonepack::packer
