// SPDX-License-Identifier: Apache-2.0
#include "packer/encode/pack_writer.hpp"

#define LZ4_HC_STATIC_LINKING_ONLY
#include <lz4.h>
#include <lz4hc.h>

#include <algorithm>
#include <stdexcept>

#include "packer/encode/format_limit.hpp"
#include "platform/base/failure.hpp"
#include "platform/base/require.hpp"

namespace zonepack::packer {
namespace {

constexpr int kCompressionLevel = 9;  // 12 saves 0.2 % for four times the time
// LZ4 must save more than 1/64 of the decoded bytes, else the chunk stays raw.
constexpr std::uint32_t kWorthDecoding = 64;
constexpr std::uint64_t kWorthFilling = 1024;

std::string message_of(const Error& error, const std::filesystem::path& folder) {
  return folder.string() + ": cannot write a pack: " + reason_text(error) +
         "; check that the folder exists, is writable and has room";
}

AtomicFile open_part(const std::filesystem::path& folder) {
  Result<AtomicFile> file = AtomicFile::create((folder / "pack.zpk").string());
  if (!file) throw std::runtime_error(message_of(file.error(), folder));
  return std::move(*file);
}

}  // namespace

PackWriter::PackWriter(const std::filesystem::path& folder, std::string zone, std::uint16_t minor)
    : folder_(folder),
      zone_(std::move(zone)),
      header_{.minor = minor},
      file_(open_part(folder)),
      compressed_(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(kSlotBytes)))),
      lz4_state_(static_cast<std::size_t>(LZ4_sizeofStateHC())) {
  write(std::as_bytes(std::span(&header_, 1)));
}

void PackWriter::add(SignatureRecord& record, float x, float y) {
  const std::uint32_t ordinal = summary_.signatures++;
  require_within(LimitId::kSignaturesOfZone, summary_.signatures, "zone " + zone_);
  summary_.features += record.features.count;
  positions_.emplace_back(x, y);
  summary_.signature_bytes.push_back(0);
  if (record.blocks) {
    if (has_layers_) record.blocks->layers_info.clear();
    has_layers_ = has_layers_ || !record.blocks->layers_info.empty();
  }
  for (SourceTable& table : tables_of(record, ordinal)) {
    const fb::PayloadKind kind = kind_of(table.part);
    Queue& queue = queues_[static_cast<std::size_t>(kind)];
    queue.tables.push_back({std::move(table), 0});
    while (fill(queue, kSlotBytes)) emit_bulk(kind, queue);
  }
  for (CoreRecord& core : core_records(record, ordinal)) core_.push_back(std::move(core));
  for (std::size_t run; (run = core_run(core_, kSlotBytes)) < core_.size();) emit_core(run);
}

// Adds waiting tables to the open chunk; true when the chunk is full and tables remain.
bool PackWriter::fill(Queue& queue, std::uint64_t capacity) {
  while (queue.whole < queue.tables.size()) {
    const Pending& next = queue.tables[queue.whole];
    const auto added = queue.chunk.add(next.table, next.next_row, capacity, lattice_);
    if (!added.all_fit) {
      queue.cut_rows = added.rows;
      return true;
    }
    ++queue.whole;
  }
  return false;
}

void PackWriter::emit_bulk(fb::PayloadKind kind, Queue& queue) {
  if (queue.chunk.empty()) {
    throw std::runtime_error("zone " + zone_ + ": one row of " + zonepack::to_string(kind) +
                             " is longer than a slot of " + std::to_string(kSlotBytes) + " bytes");
  }
  const std::uint32_t first = queue.chunk.first_signature();
  const std::uint32_t last = queue.chunk.last_signature();
  if (queue.chunk.needs_scan()) summary_.grid_needs_scan = true;
  emit(kind, queue.chunk.finish(), first, last);
  queue.tables.erase(queue.tables.begin(),
                     queue.tables.begin() + static_cast<std::ptrdiff_t>(queue.whole));
  queue.whole = 0;
  if (!queue.tables.empty()) queue.tables.front().next_row += queue.cut_rows;
  queue.cut_rows = 0;
}

void PackWriter::emit_core(std::size_t run) {
  if (run == 0) {
    throw std::runtime_error("zone " + zone_ +
                             ": the core of one signature is longer than a slot of " +
                             std::to_string(kSlotBytes) + " bytes");
  }
  const auto records = std::span<const CoreRecord>(core_).first(run);
  emit(fb::PayloadKind::Core, build_core_chunk(records), records.front().ordinal,
       records.back().ordinal);
  core_.erase(core_.begin(), core_.begin() + static_cast<std::ptrdiff_t>(run));
}

void PackWriter::emit(fb::PayloadKind kind, const Bytes& decoded, std::uint32_t first,
                      std::uint32_t last) {
  ZP_REQUIRE(decoded.size() <= kSlotBytes);
  const auto size = static_cast<std::uint32_t>(decoded.size());
  const int packed = LZ4_compress_HC_extStateHC(
      lz4_state_.data(), reinterpret_cast<const char*>(decoded.data()), compressed_.data(),
      static_cast<int>(size), static_cast<int>(compressed_.size()), kCompressionLevel);
  const bool lz4 = packed > 0 && static_cast<std::uint32_t>(packed) + size / kWorthDecoding < size;
  const auto stored =
      lz4 ? std::as_bytes(std::span(compressed_)).first(static_cast<std::size_t>(packed))
          : ByteSpan(decoded);
  auto [min_x, min_y] = positions_[first];
  auto [max_x, max_y] = positions_[first];
  for (std::uint32_t i = first; i <= last; ++i) {
    min_x = std::min(min_x, positions_[i].first);
    max_x = std::max(max_x, positions_[i].first);
    min_y = std::min(min_y, positions_[i].second);
    max_y = std::max(max_y, positions_[i].second);
  }
  const Digest16 digest = blake2b_16(stored);
  const auto stored_size = static_cast<std::uint32_t>(stored.size());
  entries_.emplace_back(offset_, xxh3(stored), flatbuffers::make_span(digest), stored_size, size,
                        first, last, min_x, min_y, max_x, max_y, kind,
                        lz4 ? fb::ChunkCodec::Lz4 : fb::ChunkCodec::Raw, std::uint16_t{0}, 0u);
  require_within(LimitId::kChunksOfPack, entries_.size(), "zone " + zone_);
  PackSummary::Payload& payload = summary_.payloads[static_cast<std::size_t>(kind)];
  payload.decoded += size;
  payload.stored += stored_size;
  ++payload.chunks;
  write(stored);
  if ((kDefaultPayload & mask_of(kind)) == 0) return;
  for (std::uint32_t i = first; i <= last; ++i) {
    summary_.signature_bytes[i] += size / (last - first + 1);
  }
}

// The last chunks of all kinds share slots: each is cut to fill the room that the previous one
// left.
void PackWriter::finish_tails() {
  Placement placement;
  const auto place = [&](const fb::ChunkEntry& entry) {
    if ((kDefaultPayload & mask_of(entry.kind())) != 0) placement.add(entry.decoded_size());
  };
  for (const fb::ChunkEntry& entry : entries_) place(entry);
  while (!core_.empty()) {
    const std::size_t run = core_run(core_, kSlotBytes);
    emit_core(run);
    place(entries_.back());
  }
  for (std::size_t k = 1; k < kPayloadKinds; ++k) {
    Queue& queue = queues_[k];
    queue.chunk = BulkChunkBuilder();
    queue.whole = 0;
    while (!queue.tables.empty()) {
      std::uint64_t room = placement.room();
      if (room < kWorthFilling) room = kSlotBytes;
      fill(queue, room);
      if (queue.chunk.empty() && room < kSlotBytes) fill(queue, kSlotBytes);
      emit_bulk(static_cast<fb::PayloadKind>(k), queue);
      place(entries_.back());
    }
  }
}

void PackWriter::write(std::span<const std::byte> bytes) {
  if (const Result<void> written = file_.write(bytes); !written) {
    throw std::runtime_error(message_of(written.error(), folder_));
  }
  offset_ += bytes.size();
}

PackSummary PackWriter::finish(PayloadMask packed) {
  finish_tails();
  flatbuffers::FlatBufferBuilder builder;
  const auto zone = builder.CreateString(zone_);
  const auto chunks = builder.CreateVectorOfStructs(entries_);
  builder.Finish(fb::CreatePackIndex(builder, zone, static_cast<std::uint32_t>(kSlotBytes),
                                     summary_.signatures, summary_.features,
                                     summary_.grid_needs_scan, chunks));
  const auto index = std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize()));
  PackTail tail;
  tail.index_offset = offset_;
  tail.index_size = index.size();
  tail.minor = header_.minor;
  tail.digest = pack_digest(header_, index, tail);
  write(index);
  write(std::as_bytes(std::span(&tail, 1)));

  summary_.digest = tail.digest;
  summary_.bytes = offset_;
  summary_.file = zone_ + "-" + to_hex(tail.digest).substr(0, 16) + ".zpk";
  const auto& root = *flatbuffers::GetRoot<fb::PackIndex>(index.data());
  const PayloadMask others = packed & ~kCoreOnly;
  PayloadMask subset = 0;
  do {  // every subset of the kinds packed, in the order of slot_table_index
    summary_.slots.push_back(slots_needed(root, subset));
    subset = (subset - others) & others;
  } while (subset != 0);
  const std::string path = (folder_ / summary_.file).string();
  if (const Result<void> done = file_.commit_as(path); !done) {
    throw std::runtime_error(message_of(done.error(), folder_));
  }
  return summary_;
}

}  // namespace zonepack::packer
