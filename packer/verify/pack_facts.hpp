// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "packer/record/record.hpp"
#include "runtime/pack_format/file/pack_file.hpp"

namespace zonepack::packer {

// What a pack holds, counted from its chunks instead of taken from its index or a manifest.
struct PackFacts {
  struct Payload {
    std::uint64_t decoded = 0, stored = 0;
    std::uint32_t chunks = 0;
  };
  struct Node {
    std::int32_t id = 0;
    Transform T_map_base{};  // as optimised; by odometry where the source had none
  };

  std::string zone;
  std::uint64_t bytes = 0;  // of the file
  Digest32 digest{};
  std::array<Payload, 32> payloads{};                             // by kind
  std::vector<std::pair<fb::PayloadKind, std::uint32_t>> chunks;  // kind, decoded size

  bool grid_needs_scan = false;  // as the index says until `complete`
  bool complete = false;         // everything decoded; otherwise the following is unset
  std::uint64_t features = 0;
  std::vector<Node> nodes;                                   // in order
  std::vector<std::pair<std::int32_t, std::int32_t>> links;  // from, to

  // Slots that the chunks of these kinds fill.
  std::uint32_t slots(PayloadMask wanted) const {
    const PayloadMask mask = payload_closure(wanted, grid_needs_scan);
    Placement placement;
    for (const auto& [kind, decoded_size] : chunks) {
      if ((mask & mask_of(kind)) != 0) placement.add(decoded_size);
    }
    return placement.slots();
  }
};

}  // namespace zonepack::packer
