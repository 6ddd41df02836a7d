// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "packer/decode/map_reader.hpp"
#include "packer/record/record.hpp"

namespace zonepack::packer {

// What a signature has in common with no other of its source, whatever their ids: the moment, and
// the odometry, a label or, without both, the place.
using SignatureIdentity = std::tuple<double, std::string, Transform>;

// Nothing when the source says too little.
std::optional<SignatureIdentity> identity_of(double stamp, const std::string& label,
                                             const std::optional<Transform>& odometry_pose,
                                             const std::optional<Transform>& pose);

// What a map holds of each signature besides its payloads, read from the core of every pack.
//
// Memory: some 200 bytes a signature and 4 bytes a link.
class HeldSignatures {
 public:
  struct Signature {
    ZoneId zone = kNoZone;
    std::int32_t session = 0;  // map_id
    double stamp = 0;
    std::optional<SignatureIdentity> identity;
    std::vector<std::int32_t> links;  // to signatures and, negative, to landmarks
  };

  explicit HeldSignatures(const MapReader& map);
  explicit HeldSignatures(std::map<std::int32_t, Signature> by_id);

  const std::map<std::int32_t, Signature>& by_id() const noexcept { return by_id_; }
  const Signature* find(std::int32_t id) const noexcept;
  // Signatures of each session.
  const std::map<std::int32_t, std::size_t>& sessions() const noexcept { return sessions_; }

 private:
  std::map<std::int32_t, Signature> by_id_;
  std::map<std::int32_t, std::size_t> sessions_;
};

}  // namespace zonepack::packer
