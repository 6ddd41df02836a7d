// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/chunk_view.hpp"

#include "runtime/pack_format/struct_alignment.hpp"

namespace zonepack {
namespace {

flatbuffers::Verifier verifier_for(ByteSpan bytes) noexcept {
  constexpr flatbuffers::uoffset_t kMaxDepth = 4;
  constexpr flatbuffers::uoffset_t kMaxTables = 4096;
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), kMaxDepth, kMaxTables};
}

bool is_attribute(fb::Field field) noexcept {
  return field == fb::Field::Shape || field == fb::Field::Info;
}

// Which codecs a field may have, so that readers need not ask before they use an accessor.
bool codec_fits(const fb::Column& column) noexcept {
  const fb::ColumnCodec codec = column.codec();
  switch (column.field()) {
    case fb::Field::Shape:
      return codec == fb::ColumnCodec::Constant;
    case fb::Field::Info:
      return codec == fb::ColumnCodec::Constant || codec == fb::ColumnCodec::Raw;
    case fb::Field::Descriptor:
      return codec == fb::ColumnCodec::Raw;
    case fb::Field::Row:
      return codec == fb::ColumnCodec::Raw || codec == fb::ColumnCodec::Lattice ||
             codec == fb::ColumnCodec::Subset;
    default:
      return codec == fb::ColumnCodec::Raw ? column.param() == 4 : codec <= fb::ColumnCodec::Blocks;
  }
}

bool record_is_sound(const fb::BulkChunk& chunk, const fb::Record& record, ByteSpan bytes,
                     const fb::ChunkEntry& entry) noexcept {
  const std::uint32_t columns = chunk.columns()->size();
  if (record.signature() < entry.first_signature() || record.signature() > entry.last_signature() ||
      record.part() > fb::Part::MAX || kind_of(record.part()) != entry.kind() ||
      record.total_rows() > kMaxRowsPerTable || record.first_row() > record.total_rows() ||
      record.rows() > record.total_rows() - record.first_row() || record.first_column() > columns ||
      record.columns() > columns - record.first_column()) {
    return false;
  }
  for (std::uint32_t i = 0; i < record.columns(); ++i) {
    const fb::Column& column = *chunk.columns()->Get(record.first_column() + i);
    if (column.field() > fb::Field::MAX || !codec_fits(column) ||
        !column_is_sound(column, bytes, is_attribute(column.field()) ? 1 : record.rows())) {
      return false;
    }
  }
  return true;
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
    case fb::Part::UserData:
    case fb::Part::LinkUserData:
      break;
  }
  return fb::PayloadKind::UserData;
}

Result<void> check_core_chunk(ByteSpan bytes, const fb::ChunkEntry& entry) noexcept {
  flatbuffers::Verifier verifier = verifier_for(bytes);
  if (!fb::VerifyCoreChunkBuffer(verifier)) return ErrorCode::kBadStructure;
  const fb::CoreChunk& chunk = *fb::GetCoreChunk(bytes.data());
  if (!is_aligned(chunk.informations())) return ErrorCode::kBadStructure;
  const std::uint32_t informations = chunk.informations() ? chunk.informations()->size() : 0;
  const std::uint32_t calibrations = chunk.calibrations() ? chunk.calibrations()->size() : 0;
  constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  if (chunk.first_signature() != entry.first_signature()) return ErrorCode::kMismatch;
  std::uint64_t ordinal = std::uint64_t{chunk.first_signature()};
  bool first = true;
  for (const fb::Signature* signature : *chunk.signatures()) {
    if (!first && !signature->continued()) ++ordinal;
    first = false;
    if (signature->calibration() != kNone && signature->calibration() >= calibrations) {
      return ErrorCode::kBadStructure;
    }
    if (!is_aligned(signature->pose()) || !is_aligned(signature->odometry_pose()) ||
        !is_aligned(signature->ground_truth_pose()) || !is_aligned(signature->links())) {
      return ErrorCode::kBadStructure;
    }
    if (signature->links() == nullptr) continue;
    for (const fb::Link* link : *signature->links()) {
      if (link->has_transform() > 1 ||
          (link->information() != kNone && link->information() >= informations)) {
        return ErrorCode::kBadStructure;
      }
    }
  }
  if (first || ordinal != entry.last_signature()) return ErrorCode::kMismatch;
  return {};
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
  for (const fb::Record* record : *chunk.records()) {
    if (!record_is_sound(chunk, *record, own, entry)) return ErrorCode::kBadStructure;
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
