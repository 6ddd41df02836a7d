// SPDX-License-Identifier: Apache-2.0
#include "packer/verify/manifest_checks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "packer/verify/problem.hpp"

namespace zonepack::packer {
namespace {

std::string quoted(const std::string& text) { return "'" + text + "'"; }

class ZoneComparison {
 public:
  ZoneComparison(const fb::Manifest& manifest, const fb::Zone& zone, const PackFacts& pack)
      : manifest_(manifest), zone_(zone), pack_(pack) {}

  Contradictions contradictions() {
    if (!names()) return std::move(contradictions_);
    compare("pack_bytes", zone_.pack_bytes(), pack_.bytes);
    compare("grid_needs_scan", zone_.grid_needs_scan(), pack_.grid_needs_scan);
    payloads();
    slots();
    if (pack_.complete) {
      compare("signatures", zone_.signatures(), pack_.nodes.size());
      compare("features", zone_.features(), pack_.features);
      nodes();
    }
    return std::move(contradictions_);
  }

 private:
  void compare(const std::string& what, std::uint64_t said, std::uint64_t found) {
    if (said == found) return;
    contradictions_.push_back("says " + what + " " + std::to_string(said) + ", the pack has " +
                              std::to_string(found));
  }

  // False when this is another pack than the one named: then nothing else is comparable.
  bool names() {
    const std::string name = zone_.name()->str();
    const std::string file = name + "-" + to_hex(pack_.digest).substr(0, 16) + ".zpk";
    if (pack_.zone != name) {
      contradictions_.push_back("names a pack of zone " + quoted(name) + ", the pack is of zone " +
                                quoted(pack_.zone));
    }
    if (!std::equal(pack_.digest.begin(), pack_.digest.end(), zone_.pack_digest()->begin())) {
      contradictions_.push_back("says digest " +
                                to_hex(std::span(zone_.pack_digest()->data(), sizeof(Digest32))) +
                                ", the pack has " + to_hex(pack_.digest));
    }
    if (!contradictions_.empty()) return false;
    if (zone_.pack()->str() != file) {
      contradictions_.push_back("names the pack " + quoted(zone_.pack()->str()) +
                                ", by its content it is " + quoted(file));
    }
    if (zone_.parent() != nullptr && !name.starts_with(zone_.parent()->str() + ".")) {
      contradictions_.push_back("says it is a part of " + quoted(zone_.parent()->str()) +
                                ", whose parts are called " + quoted(zone_.parent()->str() + ".1") +
                                " and so on");
    }
    return true;
  }

  void payloads() {
    std::uint32_t seen = 0;
    for (const fb::PayloadBytes* said : *zone_.payloads()) {
      const PackFacts::Payload& found = pack_.payloads[said->kind()];
      const std::string kind = kind_text(static_cast<fb::PayloadKind>(said->kind()));
      if ((seen >> said->kind() & 1) != 0)
        contradictions_.push_back("lists payload " + kind + " twice");
      seen |= 1u << said->kind();
      compare("decoded bytes of " + kind, said->decoded(), found.decoded);
      compare("stored bytes of " + kind, said->stored(), found.stored);
      compare("chunks of " + kind, said->chunks(), found.chunks);
    }
    for (std::uint8_t kind = 0; kind < static_cast<std::uint8_t>(pack_.payloads.size()); ++kind) {
      if (pack_.payloads[kind].chunks == 0) continue;
      const std::string name = kind_text(static_cast<fb::PayloadKind>(kind));
      if ((seen >> kind & 1) == 0) contradictions_.push_back("does not list payload " + name);
      if ((manifest_.payload_mask() >> kind & 1) == 0) {
        contradictions_.push_back("has payload " + name + ", which the map's mask leaves out");
      }
    }
  }

  void slots() {
    const PayloadMask others = manifest_.payload_mask() & ~kCoreOnly;
    PayloadMask subset = 0;
    for (const std::uint32_t said : *zone_.slots()) {
      compare("slots of payload set " + std::to_string(subset | kCoreOnly), said,
              pack_.slots(subset));
      subset = (subset - others) & others;
    }
  }

  void nodes() {
    if (zone_.nodes() == nullptr) {
      if (!pack_.nodes.empty()) contradictions_.push_back("has no nodes");
      return;
    }
    const std::size_t count = std::min<std::size_t>(zone_.nodes()->size(), pack_.nodes.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      const fb::Node& said = *zone_.nodes()->Get(i);
      const Transform& T = pack_.nodes[i].T_map_base;
      if (said.id() != pack_.nodes[i].id) {
        contradictions_.push_back("says node number " + std::to_string(i) + " is " +
                                  std::to_string(said.id()) + ", the pack has " +
                                  std::to_string(pack_.nodes[i].id));
      } else if (!same_bits(said.x(), T[3]) || !same_bits(said.y(), T[7]) ||
                 !same_bits(said.z(), T[11]) || !same_yaw(said.yaw(), T)) {
        contradictions_.push_back("places node " + std::to_string(said.id()) +
                                  " elsewhere than its pose in the pack");
      }
    }
  }

  static bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
  }
  // atan2 differs between machines in its last bits.
  static bool same_yaw(float said, const Transform& T) {
    constexpr float kLastBits_rad = 1e-6F;
    return std::abs(said - std::atan2(T[4], T[0])) <= kLastBits_rad;
  }

  const fb::Manifest& manifest_;
  const fb::Zone& zone_;
  const PackFacts& pack_;
  Contradictions contradictions_;
};

}  // namespace

Contradictions zone_contradictions(const fb::Manifest& manifest, const fb::Zone& zone,
                                   const PackFacts& pack) {
  return ZoneComparison(manifest, zone, pack).contradictions();
}

}  // namespace zonepack::packer
