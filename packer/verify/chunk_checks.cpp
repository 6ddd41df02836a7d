// SPDX-License-Identifier: Apache-2.0
#include "packer/verify/chunk_checks.hpp"

#include <algorithm>
#include <set>

namespace zonepack::packer {
namespace {

std::string record_text(std::uint32_t place, const fb::Record& record) {
  return "record " + std::to_string(place) + " (" + fb::EnumNamePart(record.part()) +
         " of signature number " + std::to_string(record.signature()) + ")";
}

bool is_cells(fb::Part part) {
  return part == fb::Part::GroundCells || part == fb::Part::ObstacleCells ||
         part == fb::Part::EmptyCells;
}

std::optional<std::string> column_problem(const fb::Record& record, const ColumnView& column) {
  if (is_attribute(column.field()) && record.first_row() != 0)
    return "repeats an attribute of the first record";
  if (column.codec() == fb::ColumnCodec::Subset && !is_cells(record.part())) {
    return "refers to points of the scan, which only grid cells do";
  }
  if (!column_is_exact(column)) {
    return std::string("column ") + fb::EnumNameField(column.field()) +
           " does not hold exactly its rows, or has bits set that its codec does not use";
  }
  return std::nullopt;
}

std::optional<std::string> bulk_chunk_problem(const fb::ChunkEntry& entry,
                                              const fb::BulkChunk& chunk) {
  const auto& bytes = *chunk.bytes();
  if (bytes.size() < kColumnPadding ||
      std::any_of(bytes.end() - kColumnPadding, bytes.end(), [](auto b) { return b != 0; })) {
    return "its columns are not followed by " + std::to_string(kColumnPadding) + " zero bytes";
  }
  std::uint32_t first = 0xFFFFFFFFu;
  std::uint32_t last = 0;
  std::uint32_t next_column = 0;
  for (std::uint32_t i = 0; i < chunk.records()->size(); ++i) {
    const fb::Record& record = *chunk.records()->Get(i);
    first = std::min(first, record.signature());
    last = std::max(last, record.signature());
    if (record.first_column() != next_column) {
      return record_text(i, record) + " begins at column " + std::to_string(record.first_column()) +
             ", expected " + std::to_string(next_column);
    }
    std::set<fb::Field> fields;
    for (; next_column < record.first_column() + record.columns(); ++next_column) {
      const fb::Column& column = *chunk.columns()->Get(next_column);
      if (!fields.insert(column.field()).second) {
        return record_text(i, record) + " has two columns " + fb::EnumNameField(column.field());
      }
      const ColumnView view = RecordView(chunk, i).column(column.field());
      if (const auto problem = column_problem(record, view)) {
        return record_text(i, record) + ": " + *problem;
      }
    }
  }
  if (next_column != chunk.columns()->size()) {
    return "holds " + std::to_string(chunk.columns()->size()) + " columns, its records " +
           std::to_string(next_column);
  }
  if (first != entry.first_signature() || last != entry.last_signature()) {
    return "holds signatures number " + std::to_string(first) + " to " + std::to_string(last) +
           ", the index says " + std::to_string(entry.first_signature()) + " to " +
           std::to_string(entry.last_signature());
  }
  return std::nullopt;
}

bool holds_links_only(const fb::Signature& s) {
  return s.id() == 0 && s.map_id() == 0 && s.weight() == 0 && s.stamp() == 0 &&
         s.calibration() == 0xFFFFFFFFu && s.label() == nullptr && s.pose() == nullptr &&
         s.odometry_pose() == nullptr && s.ground_truth_pose() == nullptr &&
         s.velocity() == nullptr && s.gps() == nullptr && s.env_sensors() == nullptr;
}

// Of a label, a sensor's blob or a calibration, which may be absent.
std::optional<std::string> length_problem(std::uint64_t size) {
  if (!is_over(LimitId::kCoreBlobBytes, size)) return std::nullopt;
  return "breaks a limit: " + to_string(Excess{LimitId::kCoreBlobBytes, size});
}

std::optional<std::string> core_chunk_problem(const fb::CoreChunk& chunk) {
  const auto size_of = [](const auto* piece) -> std::uint64_t {
    return piece == nullptr ? 0 : piece->size();
  };
  if (chunk.calibrations() != nullptr) {
    for (const fb::Calibration* calibration : *chunk.calibrations()) {
      if (auto problem = length_problem(size_of(calibration->data()))) return problem;
    }
  }
  for (const fb::Signature* signature : *chunk.signatures()) {
    for (const std::uint64_t size :
         {size_of(signature->label()), size_of(signature->velocity()), size_of(signature->gps()),
          size_of(signature->env_sensors())}) {
      if (auto problem = length_problem(size)) return problem;
    }
    if (signature->continued() && !holds_links_only(*signature)) {
      return "an entry that continues a signature holds more than links";
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> find_chunk_problem(const fb::ChunkEntry& entry, ByteSpan decoded) {
  return entry.kind() == fb::PayloadKind::Core
             ? core_chunk_problem(*fb::GetCoreChunk(decoded.data()))
             : bulk_chunk_problem(entry, *fb::GetBulkChunk(decoded.data()));
}

bool refers_to_scan(const fb::ChunkEntry& entry, ByteSpan decoded) {
  if (entry.kind() == fb::PayloadKind::Core) return false;
  const auto& columns = *fb::GetBulkChunk(decoded.data())->columns();
  return std::any_of(columns.begin(), columns.end(), [](const fb::Column* column) {
    return column->codec() == fb::ColumnCodec::Subset;
  });
}

}  // namespace zonepack::packer
