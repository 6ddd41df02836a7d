// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "packer/decode/map_reader.hpp"
#include "packer/record/record.hpp"

namespace zonepack::packer {

// The signatures of a zone's pack as they were before packing, one after the other in order of id.
// Throws std::runtime_error naming the pack when it is damaged.
//
// Memory: the decoded chunks of a run of signatures, about `window_bytes`.
class ZoneRecords {
 public:
  static constexpr ByteCount kWindowBytes = 16 * kMiB;

  ZoneRecords(const MapReader& map, const fb::Zone& zone, PayloadMask wanted = kEveryPayload,
              ByteCount window_bytes = kWindowBytes);

  // False at the end; each signature with blocks says what their layers are; `ordinal` receives the
  // signature's place in the zone.
  bool next(SignatureRecord& into, std::uint32_t* ordinal = nullptr);

 private:
  bool decode_next_window();

  std::string path_;
  PackReader pack_;
  PayloadMask wanted_;
  std::optional<DecodedPack> decoded_;
  std::vector<OrdinalRange> windows_;
  std::size_t next_window_ = 0;
  std::uint32_t next_ = 0;
  Bytes layers_info_;  // of blocks; a pack has it once
};

}  // namespace zonepack::packer
