// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/pack_format/file/manifest_file.hpp"

namespace zonepack::packer {

// How many links lead from one zone to another, either way.
class ZoneEdges {
 public:
  // `nodes`: the signatures of each zone.
  explicit ZoneEdges(const std::vector<std::vector<fb::Node>>& nodes);

  // Counts a link. Returns the zones of its ends when both have one and not the same.
  std::optional<std::pair<std::uint32_t, std::uint32_t>> add(std::int32_t from, std::int32_t to);

  // As a manifest lists them: a < b, sorted.
  std::vector<fb::ZoneEdge> list() const;

 private:
  std::map<std::int32_t, std::uint32_t> zone_of_;  // by signature
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> counts_;
};

}  // namespace zonepack::packer
