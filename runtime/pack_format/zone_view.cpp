// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/zone_view.hpp"

#include <algorithm>
#include <tuple>

namespace zonepack {
namespace {

auto table_key(const RecordView& r) { return std::tuple(r.signature(), r.part(), r.ordinal()); }

bool rows_are_complete(std::span<const RecordView> records) {
  std::uint32_t next = 0;
  for (const RecordView& record : records) {
    if (record.first_row() != next || record.total_rows() != records.front().total_rows()) {
      return false;
    }
    next += record.rows();
  }
  return next == records.front().total_rows();
}

}  // namespace

Result<ZoneView> ZoneView::make(std::span<const ChunkRef> chunks, OrdinalRange range) {
  std::vector<const fb::CoreChunk*> cores;
  std::vector<RecordView> records;
  for (const ChunkRef& ref : chunks) {
    if (ref.kind == fb::PayloadKind::Core) {
      cores.push_back(fb::GetCoreChunk(ref.bytes.data()));
      continue;
    }
    const fb::BulkChunk* const chunk = fb::GetBulkChunk(ref.bytes.data());
    for (std::uint32_t i = 0; i < chunk->records()->size(); ++i) {
      const RecordView record(*chunk, i);
      if (range.contains(record.signature())) records.push_back(record);
    }
  }
  return make(cores, std::move(records), range);
}

Result<ZoneView> ZoneView::make(std::span<const fb::CoreChunk* const> core_chunks,
                                std::vector<RecordView> records, OrdinalRange range) {
  ZoneView view;
  view.first_ = range.first;
  view.records_ = std::move(records);
  std::vector<std::pair<std::uint32_t, Core>> cores;
  for (const fb::CoreChunk* const chunk : core_chunks) {
    std::uint32_t ordinal = chunk->first_signature();
    bool first = true;
    for (const fb::Signature* signature : *chunk->signatures()) {
      if (!first && !signature->continued()) ++ordinal;
      first = false;
      if (range.contains(ordinal)) cores.push_back({ordinal, {chunk, signature, {}}});
    }
  }
  std::stable_sort(cores.begin(), cores.end(), [](const auto& a, const auto& b) {
    return std::pair(a.first, a.second.signature->continued()) <
           std::pair(b.first, b.second.signature->continued());
  });
  for (auto& [ordinal, core] : cores) {
    if (core.signature->continued()) {
      if (view.core_.empty() || ordinal + 1 != range.first + view.core_.size()) {
        return {ErrorCode::kMismatch, ordinal};
      }
      view.core_.back().more_links.push_back({core.chunk, core.signature});
      continue;
    }
    if (ordinal != range.first + view.core_.size() ||
        (!view.core_.empty() && view.core_.back().signature->id() >= core.signature->id())) {
      return {ErrorCode::kMismatch, ordinal};
    }
    view.core_.push_back(std::move(core));
  }
  std::stable_sort(view.records_.begin(), view.records_.end(),
                   [](const RecordView& a, const RecordView& b) {
                     return std::tuple(table_key(a), a.first_row(), a.rows()) <
                            std::tuple(table_key(b), b.first_row(), b.rows());
                   });
  const std::span<const RecordView> all(view.records_);
  for (std::size_t begin = 0; begin < all.size();) {
    std::size_t end = begin + 1;
    while (end < all.size() && table_key(all[end]) == table_key(all[begin])) ++end;
    const auto own = all.subspan(begin, end - begin);
    const std::uint32_t place = own[0].signature() - range.first;
    if (place >= view.size() || !rows_are_complete(own)) {
      return {ErrorCode::kMismatch, own[0].signature()};
    }
    while (view.first_table_.size() <= place) {
      view.first_table_.push_back(view.tables_.size());
    }
    view.tables_.emplace_back(own);
    begin = end;
  }
  while (view.first_table_.size() <= view.core_.size()) {
    view.first_table_.push_back(view.tables_.size());
  }
  Result<BlockIndex> blocks = BlockIndex::make(view.records_);
  if (!blocks) return blocks.error();
  view.blocks_ = std::move(*blocks);
  return view;
}

const TableView* ZoneView::table(std::uint32_t ordinal, fb::Part part) const noexcept {
  for (const TableView& table : tables(ordinal)) {
    if (table.part() == part) return &table;
  }
  return nullptr;
}

}  // namespace zonepack
