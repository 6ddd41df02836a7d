// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "packer/build/placing.hpp"
#include "packer/build/sessions.hpp"
#include "packer/zones/partition.hpp"
#include "platform/base/byte_count.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

// What a manifest says of how its map was packed.
namespace zonepack::packer {

// What the source spends on its signatures.
struct SourceBytes {
  std::uint64_t features = 0;
  ByteCount feature_rows = 0;
  ByteCount bytes = 0;  // these, and the zlib blobs of scans and grids
};
SourceBytes source_bytes(const MapOutline& outline) noexcept;

// The options that change bytes.
struct Packing {
  OrphanPolicy orphans = OrphanPolicy::kNearest;
  UnlinkedPolicy unlinked = UnlinkedPolicy::kOdometry;
  ByteCount max_zone_bytes = 0;
  double snap_m = 0;
  SessionChoice sessions;
};

// "orphans=nearest unlinked=odometry max_zone_bytes=0 snap=0.1", and what was chosen of sessions.
std::string packing_text(const Packing& packing);

// Reads that text; what it does not say is as the command line has it by default. Sessions that
// were chosen are not read.
Packing packing_of(const fb::Manifest& manifest);

}  // namespace zonepack::packer
