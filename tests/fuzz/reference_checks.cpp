// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/reference_checks.hpp"

#include <cstring>

#include "runtime/pack_format/chunk_view.hpp"
#include "runtime/pack_format/struct_alignment.hpp"

namespace zonepack::fuzz {
namespace {

flatbuffers::Verifier verifier_for(ByteSpan bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), 4, 4096};
}

bool refers(std::uint32_t place, std::uint32_t count) {
  return place == 0xFFFFFFFFu || place < count;
}

bool accepts_core(ByteSpan bytes, const fb::ChunkEntry& entry) {
  flatbuffers::Verifier verifier = verifier_for(bytes);
  if (!fb::VerifyCoreChunkBuffer(verifier)) return false;
  const fb::CoreChunk& chunk = *fb::GetCoreChunk(bytes.data());
  if (!is_aligned(chunk.informations())) return false;
  const std::uint32_t informations = chunk.informations() ? chunk.informations()->size() : 0;
  const std::uint32_t calibrations = chunk.calibrations() ? chunk.calibrations()->size() : 0;
  std::uint64_t begun = 0;
  for (const fb::Signature* s : *chunk.signatures()) {
    if (begun == 0 || !s->continued()) ++begun;
    if (!refers(s->calibration(), calibrations)) return false;
    if (!is_aligned(s->pose()) || !is_aligned(s->odometry_pose()) ||
        !is_aligned(s->ground_truth_pose()) || !is_aligned(s->links())) {
      return false;
    }
    if (s->links() == nullptr) continue;
    for (const fb::Link* link : *s->links()) {
      if (link->has_transform() > 1 || !refers(link->information(), informations)) return false;
    }
  }
  return begun > 0 && chunk.first_signature() == entry.first_signature() &&
         chunk.first_signature() + (begun - 1) == entry.last_signature();
}

bool codec_fits(const fb::Column& column) {
  using Codec = fb::ColumnCodec;
  const Codec codec = column.codec();
  switch (column.field()) {
    case fb::Field::Shape:
      return codec == Codec::Constant;
    case fb::Field::Info:
      return codec == Codec::Constant || codec == Codec::Raw;
    case fb::Field::Descriptor:
      return codec == Codec::Raw;
    case fb::Field::Row:
      return codec == Codec::Raw || codec == Codec::Lattice || codec == Codec::Subset;
    default:
      return codec == Codec::Raw ? column.param() == 4 : codec <= Codec::Blocks;
  }
}

bool blocks_fit(ByteSpan bytes, std::uint64_t rows) {
  const std::uint64_t blocks = (rows + kBlockRows - 1) / kBlockRows;
  if (blocks * sizeof(BlockHeader) > bytes.size()) return false;
  std::uint64_t words = 0;
  for (std::uint64_t i = 0; i < blocks; ++i) {
    BlockHeader header;
    std::memcpy(&header, bytes.data() + i * sizeof header, sizeof header);
    if (header.bits > 32 || header.reserved != 0 || header.offset != words) return false;
    words += header.bits;
  }
  return blocks * sizeof(BlockHeader) + words * 4 == bytes.size();
}

bool lattice_fits(ByteSpan bytes, std::uint64_t rows) {
  LatticeHeader header;
  if (bytes.size() < sizeof header) return false;
  std::memcpy(&header, bytes.data(), sizeof header);
  const auto is_near = [](std::int32_t index) { return index > -(1 << 24) && index < 1 << 24; };
  const std::uint64_t cells = std::uint64_t{header.width} * header.height;
  return header.width < 1 << 24 && header.height < 1 << 24 && is_near(header.first_x) &&
         is_near(header.first_y) && cells >= rows &&
         bytes.size() == sizeof header + (cells + 7) / 8;
}

bool column_fits(const fb::Column& column, ByteSpan bytes, std::uint64_t rows) {
  if (column.field() > fb::Field::MAX || !codec_fits(column)) return false;
  const std::uint64_t end = std::uint64_t{column.offset()} + column.size();
  if (end + kColumnPadding > bytes.size()) return false;
  const ByteSpan own = bytes.subspan(column.offset(), column.size());
  const auto base = static_cast<std::int64_t>(column.base());
  const std::uint64_t packed = (rows * column.bits() + 7) / 8;
  switch (column.codec()) {
    case fb::ColumnCodec::Raw:
      return own.size() == rows * column.param();
    case fb::ColumnCodec::Constant:
      return own.empty();
    case fb::ColumnCodec::Packed:
      return column.bits() <= 32 && own.size() == packed;
    case fb::ColumnCodec::Scaled:
      return column.bits() <= 25 && column.param() <= 15 && base > -(1 << 24) && base < 1 << 24 &&
             own.size() == packed;
    case fb::ColumnCodec::Blocks:
      return blocks_fit(own, rows);
    case fb::ColumnCodec::Lattice:
      return lattice_fits(own, rows);
    case fb::ColumnCodec::Subset:
      return column.base() >> 32 >= rows && own.size() == ((column.base() >> 32) + 7) / 8;
  }
  return false;
}

bool record_fits(const fb::BulkChunk& chunk, const fb::Record& record, ByteSpan bytes,
                 const fb::ChunkEntry& entry) {
  if (record.signature() < entry.first_signature() || record.signature() > entry.last_signature() ||
      record.part() > fb::Part::MAX || kind_of(record.part()) != entry.kind() ||
      record.total_rows() > kMaxRowsPerTable ||
      std::uint64_t{record.first_row()} + record.rows() > record.total_rows() ||
      std::uint64_t{record.first_column()} + record.columns() > chunk.columns()->size()) {
    return false;
  }
  for (std::uint32_t i = 0; i < record.columns(); ++i) {
    const fb::Column& column = *chunk.columns()->Get(record.first_column() + i);
    const bool one_row = column.field() == fb::Field::Shape || column.field() == fb::Field::Info;
    if (!column_fits(column, bytes, one_row ? 1 : record.rows())) return false;
  }
  return true;
}

bool accepts_bulk(ByteSpan bytes, const fb::ChunkEntry& entry) {
  flatbuffers::Verifier verifier = verifier_for(bytes);
  if (!fb::VerifyBulkChunkBuffer(verifier)) return false;
  const fb::BulkChunk& chunk = *fb::GetBulkChunk(bytes.data());
  if (!is_aligned(chunk.records()) || !is_aligned(chunk.columns())) return false;
  const ByteSpan own{reinterpret_cast<const std::byte*>(chunk.bytes()->data()),
                     chunk.bytes()->size()};
  for (const fb::Record* record : *chunk.records()) {
    if (!record_fits(chunk, *record, own, entry)) return false;
  }
  return true;
}

}  // namespace

bool reference_accepts(ByteSpan chunk, const fb::ChunkEntry& entry) {
  return entry.kind() == fb::PayloadKind::Core ? accepts_core(chunk, entry)
                                               : accepts_bulk(chunk, entry);
}

}  // namespace zonepack::fuzz
