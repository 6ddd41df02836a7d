// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "packer/record/record.hpp"

namespace zonepack::packer {

inline constexpr std::size_t kLinksPerCoreRecord = 32;  // the rest goes to further records

// What the core of a pack keeps of a signature: everything but its tables.
struct CoreRecord {
  std::uint32_t ordinal = 0;
  bool continued = false;        // more links of the previous record
  SignatureRecord record;        // payload members unused
  std::uint64_t size_bound = 0;  // of its encoded form
};

// The core records of a signature: one, or several when it has many links. Moves the links and
// blobs out of `record` and leaves the payloads. Throws when a blob is longer than a pack allows.
std::vector<CoreRecord> core_records(SignatureRecord& record, std::uint32_t ordinal);

// The length of the longest run from the front whose chunk takes at most `capacity` bytes; may be
// 0.
std::size_t core_run(std::span<const CoreRecord> records, std::uint64_t capacity);

// A core chunk of these records as a FlatBuffer.
Bytes build_core_chunk(std::span<const CoreRecord> records);

}  // namespace zonepack::packer
