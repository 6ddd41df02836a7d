// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/entries.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "packer/decode/record_decoder.hpp"
#include "packer/encode/core_chunk_builder.hpp"
#include "packer/verify/chunk_checks.hpp"
#include "packer/verify/map_verifier.hpp"
#include "runtime/pack_format/file/accounting.hpp"
#include "runtime/pack_format/file/pack_file.hpp"
#include "runtime/pack_format/struct_alignment.hpp"
#include "runtime/pack_format/zone_view.hpp"
#include "runtime/settings/dbc_file.hpp"
#include "tests/support/memory_folder.hpp"

namespace zonepack::fuzz {
namespace {

// Bytes at an address that is a multiple of 64, with nothing readable after them.
class Aligned {
 public:
  explicit Aligned(std::size_t size)
      : bytes_(static_cast<std::byte*>(::operator new (size, std::align_val_t{64}))), size_(size) {}
  explicit Aligned(ByteSpan bytes) : Aligned(bytes.size()) {
    if (size_ != 0) std::memcpy(bytes_, bytes.data(), size_);
  }
  ~Aligned() { ::operator delete (bytes_, std::align_val_t{64}); }
  Aligned(const Aligned&) = delete;
  Aligned& operator=(const Aligned&) = delete;
  std::byte* data() { return bytes_; }
  std::span<std::byte> span() { return {bytes_, size_}; }

 private:
  std::byte* bytes_;
  std::size_t size_;
};

volatile std::uint64_t sink;

std::uint64_t sum_of(ByteSpan bytes) {
  std::uint64_t sum = 0;
  for (const std::byte byte : bytes) sum += std::to_integer<unsigned>(byte);
  return sum;
}

void read_column(const ColumnView& column) {
  std::uint64_t sum = sum_of(column.bytes());
  constexpr std::uint32_t kEnds = 5000;  // a constant may have a million rows
  switch (column.codec()) {
    case fb::ColumnCodec::Lattice:
      for_each_cell(column, [&](float x, float y) { sum += x < y; });
      break;
    case fb::ColumnCodec::Subset:
      for_each_scan_index(column, [&](std::uint32_t index) { sum += index; });
      break;
    case fb::ColumnCodec::Raw:
      for (std::uint32_t i = 0; i < std::min(column.rows(), kEnds); ++i) {
        sum += sum_of(column.raw_at(i)) + sum_of(column.raw_at(column.rows() - 1 - i));
      }
      break;
    default:
      for (std::uint32_t i = 0; i < std::min(column.rows(), kEnds); ++i) {
        sum += column.bits_at(i) + column.bits_at(column.rows() - 1 - i);
      }
  }
  sink = sum + column_is_exact(column);
}

// A core for the signatures that a bulk chunk speaks of.
packer::Bytes core_for(std::uint32_t last) {
  std::vector<packer::CoreRecord> records;
  for (std::uint32_t i = 0; i <= last; ++i) {
    packer::CoreRecord& core = records.emplace_back();
    core.ordinal = i;
    core.record.id = static_cast<std::int32_t>(i + 1);
    core.record.links.resize(2);
  }
  return packer::build_core_chunk(records);
}

void decode_records(std::span<const ChunkRef> chunks) {
  const Result<ZoneView> view = ZoneView::make(chunks);
  if (!view) return;
  for (std::uint32_t i = 0; i < view->size(); ++i) {
    std::uint64_t rows = 0;
    for (const TableView& table : view->tables(i)) rows += table.total_rows();
    if (rows > 1'000'000) continue;  // decoding allocates by rows
    try {
      sink = packer::decode_record(*view, i).links.size();
    } catch (const std::runtime_error&) {
      // tables that contradict each other, by name of the signature
    }
  }
}

void read_bulk(const fb::ChunkEntry& entry, ByteSpan bytes) {
  const fb::BulkChunk& chunk = *fb::GetBulkChunk(bytes.data());
  for (std::uint32_t i = 0; i < chunk.records()->size(); ++i) {
    const RecordView record(chunk, i);
    for (const fb::Field field : fb::EnumValuesField()) {
      if (const ColumnView column = record.column(field)) read_column(column);
    }
  }
  if (entry.last_signature() > 64) return;
  const packer::Bytes core = core_for(entry.last_signature());
  Aligned aligned{ByteSpan(core)};
  const ChunkRef chunks[] = {{fb::PayloadKind::Core, aligned.span()}, {entry.kind(), bytes}};
  decode_records(chunks);
}

bool read_decoded(const fb::ChunkEntry& entry, ByteSpan bytes) {
  if (!check_chunk(bytes, entry)) return false;
  sink =
      packer::find_chunk_problem(entry, bytes).has_value() + packer::refers_to_scan(entry, bytes);
  if (entry.kind() == fb::PayloadKind::Core) {
    const ChunkRef chunk{entry.kind(), bytes};
    decode_records({&chunk, 1});
  } else {
    read_bulk(entry, bytes);
  }
  return true;
}

template <typename T>
T take(ByteSpan& bytes) {
  T value{};
  const std::size_t size = std::min(sizeof value, bytes.size());
  if (size != 0) std::memcpy(&value, bytes.data(), size);
  bytes = bytes.subspan(size);
  return value;
}

fb::PayloadKind take_kind(ByteSpan& bytes) {
  return static_cast<fb::PayloadKind>(take<std::uint8_t>(bytes) % kPayloadKinds);
}

}  // namespace

bool read_pack(ByteSpan bytes) {
  test_support::MemoryFolder folder;
  folder.files["a.zpk"] = packer::Bytes(bytes.begin(), bytes.end());
  return packer::verify_one_pack(folder, "a.zpk").whole();
}

bool read_index(ByteSpan bytes) {
  Aligned index(bytes);
  const PackHeader header;
  PackTail tail;
  // The index says where the chunks end.
  tail.index_offset = sizeof header;
  flatbuffers::Verifier verifier(reinterpret_cast<const std::uint8_t*>(index.data()), bytes.size());
  if (verifier.VerifyBuffer<fb::PackIndex>() &&
      is_aligned(flatbuffers::GetRoot<fb::PackIndex>(index.data())->chunks())) {
    for (const fb::ChunkEntry* entry :
         *flatbuffers::GetRoot<fb::PackIndex>(index.data())->chunks()) {
      tail.index_offset = entry->offset() + entry->stored_size();
    }
  }
  tail.index_size = bytes.size();
  tail.digest = pack_digest(header, index.span(), tail);
  const auto checked = check_index(std::as_bytes(std::span(&header, 1)), index.span(), tail);
  if (!checked) return false;
  for (PayloadMask mask = 0; mask <= kEveryPayload; ++mask) sink = slots_needed(**checked, mask);
  sink = (*checked)->zone()->str().size();
  return true;
}

bool read_chunk(ByteSpan bytes) {
  const fb::PayloadKind kind = take_kind(bytes);
  const auto first = take<std::uint32_t>(bytes);
  const auto last = take<std::uint32_t>(bytes);
  if (bytes.empty() || bytes.size() > kSlotBytes) return false;
  const auto size = static_cast<std::uint32_t>(bytes.size());
  const Digest16 digest{};
  const fb::ChunkEntry entry(0, 0, flatbuffers::make_span(digest), size, size, first, last, 0, 0, 0,
                             0, kind, fb::ChunkCodec::Raw, 0, 0);
  Aligned chunk(bytes);
  return read_decoded(entry, chunk.span());
}

bool read_block(ByteSpan bytes) {
  const fb::PayloadKind kind = take_kind(bytes);
  const auto decoded_size = take<std::uint32_t>(bytes) % kSlotBytes + 1;
  if (bytes.empty() || bytes.size() > kSlotBytes) return false;
  const Digest16 digest{};
  const fb::ChunkEntry entry(
      0, xxh3(bytes), flatbuffers::make_span(digest), static_cast<std::uint32_t>(bytes.size()),
      static_cast<std::uint32_t>(decoded_size), 0, 0, 0, 0, 0, 0, kind, fb::ChunkCodec::Lz4, 0, 0);
  Aligned out(kSlotBytes);
  const Result<ByteSpan> chunk = decode_chunk(entry, bytes, out.data());
  return chunk.ok() && read_decoded(entry, *chunk);
}

bool read_manifest(ByteSpan bytes) {
  Aligned file(sizeof(ManifestHeader) + bytes.size() + sizeof(ManifestTail));
  ManifestHeader header;
  header.minor = kManifestMinor;
  header.size = static_cast<std::uint32_t>(bytes.size());
  std::memcpy(file.data(), &header, sizeof header);
  if (!bytes.empty()) std::memcpy(file.data() + sizeof header, bytes.data(), bytes.size());
  const std::size_t body = sizeof header + bytes.size();
  ManifestTail tail;
  tail.digest = blake2b_32({file.span().first(body)});
  std::memcpy(file.data() + body, &tail, sizeof tail);
  const Result<const fb::Manifest*> checked = check_manifest(file.span());
  if (!checked) return false;
  const fb::Manifest& manifest = **checked;
  for (const PayloadMask wanted : {kCoreOnly, kDefaultPayload, kEveryPayload}) {
    const MapCosts costs = map_costs(manifest, file.span().size(), wanted);
    const ZoneId pinned[] = {0, 1};
    sink = smallest_budget(costs, pinned).bytes;
  }
  for (const fb::Zone* zone : *manifest.zones()) {
    const Polygon polygon = polygon_of(*zone);
    sink = static_cast<std::uint64_t>(side_of(polygon, polygon.outer[0]));
    if (zone->nodes() != nullptr) {
      for (const fb::Node* node : *zone->nodes()) sink = static_cast<std::uint64_t>(node->id());
    }
  }
  test_support::MemoryFolder folder;
  folder.files[std::string(kManifestName)] = {file.span().begin(), file.span().end()};
  sink = packer::verify_map(folder).problems.size();
  return true;
}

bool read_dbc(ByteSpan bytes) {
  Aligned file(bytes);
  const LoadedDbc loaded =
      parse_dbc({reinterpret_cast<const char*>(file.data()), bytes.size()}, "a.dbc");
  CanFrame frame;
  frame.len = 64;
  for (const DbcMessage& message : loaded.file.messages()) {
    frame.id = message.id;
    frame.extended = message.extended;
    for (const DbcSignal& signal : message.signals) {
      const auto found = loaded.file.find(message.name + "." + signal.name);
      if (found) {
        sink = static_cast<std::uint64_t>(read_signal(found->signal, frame).raw);
      } else if (found.error().message.empty()) {
        std::abort();
      }
    }
  }
  return loaded.ok();
}

}  // namespace zonepack::fuzz
