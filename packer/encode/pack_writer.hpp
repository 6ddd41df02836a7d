// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "packer/encode/bulk_chunk_builder.hpp"
#include "packer/encode/core_chunk_builder.hpp"
#include "platform/files/atomic_file.hpp"
#include "runtime/pack_format/file/pack_file.hpp"

namespace zonepack::packer {

// A finished pack, as the manifest describes it.
struct PackSummary {
  std::string file;  // ZONE-<16 hex digits of the digest>.zpk
  std::uint64_t bytes = 0;
  Digest32 digest{};
  std::uint32_t signatures = 0;
  std::uint64_t features = 0;
  bool grid_needs_scan = false;
  struct Payload {
    std::uint64_t decoded = 0, stored = 0;
    std::uint32_t chunks = 0;
  };
  std::array<Payload, kPayloadKinds> payloads{};
  std::vector<std::uint32_t> slots;  // by set of kinds packed, as in the manifest
  // Each signature's share of the decoded bytes of the default payload, for splitting.
  std::vector<std::uint64_t> signature_bytes;
};

// Writes one zone's pack while its signatures arrive, in order of id. The same signatures give the
// same bytes.
//
// Memory: the index, and at most a slot or two of rows of each payload kind.
class PackWriter {
 public:
  // `minor`: kPackMinorOfBlocks where signatures may hold blocks of voxels.
  PackWriter(const std::filesystem::path& folder, std::string zone, std::uint16_t minor = 0);

  // Consumes `record`. x, y: position of its base in the map frame, metres.
  void add(SignatureRecord& record, float x, float y);

  // Writes the remaining rows, the index and the tail, and gives the file its name.
  PackSummary finish(PayloadMask packed);

 private:
  struct Pending {
    SourceTable table;
    std::uint32_t next_row = 0;
  };
  struct Queue {
    std::deque<Pending> tables;
    BulkChunkBuilder chunk;      // the open chunk; holds ...
    std::size_t whole = 0;       // ... so many whole tables from the front
    std::uint32_t cut_rows = 0;  // ... and so many rows of the next one
  };

  bool fill(Queue& queue, std::uint64_t capacity);
  void emit_bulk(fb::PayloadKind kind, Queue& queue);
  void emit_core(std::size_t run);
  void emit(fb::PayloadKind kind, const Bytes& decoded, std::uint32_t first, std::uint32_t last);
  void write(std::span<const std::byte> bytes);
  void finish_tails();

  std::filesystem::path folder_;
  std::string zone_;
  PackHeader header_;
  AtomicFile file_;
  std::uint64_t offset_ = 0;
  std::vector<fb::ChunkEntry> entries_;
  std::vector<CoreRecord> core_;
  std::array<Queue, kPayloadKinds> queues_;
  LatticeEncoder lattice_;
  bool has_layers_ = false;  // what the layers of blocks are is written, once a pack
  std::vector<std::pair<float, float>> positions_;
  std::vector<char> compressed_;
  std::vector<char> lz4_state_;
  PackSummary summary_;
};

}  // namespace zonepack::packer
