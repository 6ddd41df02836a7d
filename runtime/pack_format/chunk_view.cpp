// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/chunk_view.hpp"

#include <span>

#include "runtime/pack_format/struct_alignment.hpp"

namespace zonepack {
namespace {

flatbuffers::Verifier verifier_for(ByteSpan bytes) noexcept {
  constexpr flatbuffers::uoffset_t kMaxDepth = 4;
  constexpr flatbuffers::uoffset_t kMaxTables = 4096;
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), kMaxDepth, kMaxTables};
}

bool record_is_sound(const fb::Record& record, std::span<const fb::Column> columns, ByteSpan bytes,
                     const fb::ChunkEntry& entry) noexcept {
  return record.signature() >= entry.first_signature() &&
         record.signature() <= entry.last_signature() && record.part() <= fb::Part::MAX &&
         kind_of(record.part()) == entry.kind() && record.first_row() <= record.total_rows() &&
         record.rows() <= record.total_rows() - record.first_row() &&
         record.first_column() <= columns.size() &&
         record.columns() <= columns.size() - record.first_column() &&
         columns_are_sound(columns.subspan(record.first_column(), record.columns()), bytes,
                           record.rows());
}

}  // namespace

const char* to_string(fb::PayloadKind kind) noexcept {
  switch (kind) {
    case fb::PayloadKind::Core:
      return "core";
    case fb::PayloadKind::Features:
      return "features";
    case fb::PayloadKind::Scan:
      return "scan";
    case fb::PayloadKind::Grid:
      return "grid";
    case fb::PayloadKind::Image:
      return "image";
    case fb::PayloadKind::Depth:
      return "depth";
    case fb::PayloadKind::UserData:
      return "userdata";
    case fb::PayloadKind::Blocks:
      return "blocks";
  }
  return nullptr;
}

fb::PayloadKind kind_of(fb::Part part) noexcept {
  switch (part) {
    case fb::Part::Features:
    case fb::Part::GlobalDescriptor:
      return fb::PayloadKind::Features;
    case fb::Part::Scan:
      return fb::PayloadKind::Scan;
    case fb::Part::GroundCells:
    case fb::Part::ObstacleCells:
    case fb::Part::EmptyCells:
    case fb::Part::GridInfo:
      return fb::PayloadKind::Grid;
    case fb::Part::Image:
      return fb::PayloadKind::Image;
    case fb::Part::Depth:
    case fb::Part::DepthConfidence:
      return fb::PayloadKind::Depth;
    case fb::Part::BlockLayers:
    case fb::Part::TsdfBlocks:
    case fb::Part::ColorBlocks:
    case fb::Part::OccupancyBlocks:
    case fb::Part::EsdfBlocks:
      return fb::PayloadKind::Blocks;
    case fb::Part::UserData:
    case fb::Part::LinkUserData:
      break;
  }
  return fb::PayloadKind::UserData;
}

Result<void> check_bulk_chunk(ByteSpan bytes, const fb::ChunkEntry& entry) noexcept {
  flatbuffers::Verifier verifier = verifier_for(bytes);
  if (!fb::VerifyBulkChunkBuffer(verifier)) return ErrorCode::kBadStructure;
  const fb::BulkChunk& chunk = *fb::GetBulkChunk(bytes.data());
  if (!is_aligned(chunk.records()) || !is_aligned(chunk.columns())) {
    return ErrorCode::kBadStructure;
  }
  const ByteSpan own{reinterpret_cast<const std::byte*>(chunk.bytes()->data()),
                     chunk.bytes()->size()};
  const std::span<const fb::Column> columns{
      reinterpret_cast<const fb::Column*>(chunk.columns()->Data()), chunk.columns()->size()};
  for (const fb::Record* record : *chunk.records()) {
    if (is_over(LimitId::kRowsOfTable, record->total_rows())) {
      return over_limit(LimitId::kRowsOfTable, record->total_rows());
    }
    if (!record_is_sound(*record, columns, own, entry)) return ErrorCode::kBadStructure;
  }
  return {};
}

Result<void> check_chunk(ByteSpan bytes, const fb::ChunkEntry& entry) noexcept {
  return entry.kind() == fb::PayloadKind::Core ? check_core_chunk(bytes, entry)
                                               : check_bulk_chunk(bytes, entry);
}

ColumnView RecordView::column(fb::Field field) const noexcept {
  for (std::uint32_t i = 0; i < record_->columns(); ++i) {
    const fb::Column& column = columns_[i];
    if (column.field() == field) {
      return {column, bytes_, is_attribute(field) ? 1 : record_->rows()};
    }
  }
  return {};
}

}  // namespace zonepack
