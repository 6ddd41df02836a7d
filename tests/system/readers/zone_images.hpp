// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/client/signature_view.hpp"
#include "runtime/pack_format/file/pack_reader.hpp"

namespace zonepack::test_support {

// Contents that zones are filled with in turn, all different: a read that mixes two of them gives
// what neither holds.
class ZoneImages {
 public:
  explicit ZoneImages(std::uint32_t count);

  std::uint32_t size() const { return static_cast<std::uint32_t>(packs_.size()); }
  const std::vector<ChunkRef>& chunks(std::uint32_t image) const { return packs_[image].chunks(); }
  std::uint32_t slots(std::uint32_t image) const { return slots_[image]; }
  std::uint32_t signatures(std::uint32_t image) const { return packs_[image].view().size(); }

  // The image that these signatures are, judged by every value read; size() when they are none.
  std::uint32_t recognise(const ZoneSignatures& signatures) const;

 private:
  std::vector<DecodedPack> packs_;
  std::vector<std::uint32_t> slots_;
  std::vector<std::uint64_t> digests_;
};

// A number made of every value of every signature, read through the accessors of clients.
std::uint64_t digest_of(const ZoneSignatures& signatures);

}  // namespace zonepack::test_support
