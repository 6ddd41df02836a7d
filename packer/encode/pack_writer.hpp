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
#include "platform/atomic_file.hpp"
#include "runtime/pack_format/file/pack_file.hpp"

namespace zonepack::packer {

// A finished pack, as the manifest tells of it.
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
  std::vector<std::uint32_t> slots;            // by set of kinds packed, as in the manifest
  std::vector<std::uint64_t> signature_bytes;  // decoded share of each signature in what is loaded
                                               // by default, for splitting
};

// Writes one zone's pack as its signatures come, in order of id. Holds at most a slot or two of
// rows of each payload kind beside the index. Same signatures, same bytes.
class PackWriter {
 public:
  PackWriter(const std::filesystem::path& folder, std::string zone);

  // `record` is consumed. x, y: where its base stands in the map, metres.
  void add(SignatureRecord& record, float x, float y);

  // Writes what is left, index and tail, and gives the file its name.
  PackSummary finish(PayloadMask packed);

 private:
  struct Pending {
    SourceTable table;
    std::uint32_t next_row = 0;
  };
  struct Queue {
    std::deque<Pending> tables;
    BulkChunkBuilder chunk;  // the open chunk: `whole` tables from the front, and
    std::size_t whole = 0;
    std::uint32_t cut_rows = 0;  // some rows of the next one
  };

  bool fill(Queue& queue, std::uint64_t capacity);
  void emit_bulk(fb::PayloadKind kind, Queue& queue);
  void emit_core(std::size_t run);
  void emit(fb::PayloadKind kind, const Bytes& decoded, std::uint32_t first, std::uint32_t last);
  void write(std::span<const std::byte> bytes);
  void finish_tails();

  std::filesystem::path folder_;
  std::string zone_;
  AtomicFile file_;
  std::uint64_t offset_ = 0;
  std::vector<fb::ChunkEntry> entries_;
  std::vector<CoreRecord> core_;
  std::array<Queue, kPayloadKinds> queues_;
  LatticeEncoder lattice_;
  std::vector<std::pair<float, float>> positions_;
  std::vector<char> compressed_;
  std::vector<char> lz4_state_;
  PackSummary summary_;
};

}  // namespace zonepack::packer
