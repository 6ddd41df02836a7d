// SPDX-License-Identifier: Apache-2.0
#include "runtime/client/signature_view.hpp"

#include <cstring>

namespace zonepack {
namespace {

std::optional<RigidTransform> transform_of(const fb::Transform* transform) noexcept {
  if (transform == nullptr) return std::nullopt;
  RigidTransform out;
  static_assert(sizeof out == sizeof *transform);
  std::memcpy(out.data(), transform, sizeof out);
  return out;
}

// An Info attribute of a known length, as it is now.
template <typename T>
std::optional<T> info_of(const TableView* table) noexcept {
  if (table == nullptr) return std::nullopt;
  const ColumnView info = table->attribute(fb::Field::Info);
  if (!info || info.bytes().size() < sizeof(T)) return std::nullopt;
  return read_once<T>(info.bytes().data());
}

struct ScanInfo {
  std::int32_t format;
  float range_min, range_max, angle_min, angle_max, angle_increment, max_points;
  RigidTransform T_base_scan;
};
static_assert(sizeof(ScanInfo) == 76);

struct GridInfo {
  float cell;
  std::array<float, 3> view_point;
};

}  // namespace

std::uint64_t FeaturesView::info() const noexcept {
  if (table_ == nullptr) return 0;
  const ColumnView info = table_->attribute(fb::Field::Info);
  return info && info.codec() == fb::ColumnCodec::Constant ? info.base() : 0;
}

DescriptorType FeaturesView::descriptor_type() const noexcept {
  const std::uint64_t type = info() >> 32;
  return type > 2 ? DescriptorType::kNone : static_cast<DescriptorType>(type);
}

std::uint32_t FeaturesView::descriptor_dim() const noexcept {
  return static_cast<std::uint32_t>(info());
}

FeaturesView::Columns::Columns(const RecordView& record) noexcept {
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    columns_[i] = record.column(static_cast<fb::Field>(static_cast<std::size_t>(fb::Field::X) + i));
  }
}

Feature FeaturesView::Columns::feature(std::uint32_t row) const noexcept {
  const auto number = [&](std::size_t i) { return columns_[i] ? columns_[i].float_at(row) : 0.0F; };
  const auto integer = [&](std::size_t i) { return columns_[i] ? columns_[i].int_at(row) : 0; };
  return {number(0),
          number(1),
          number(2),
          number(3),
          number(4),
          integer(5),
          integer(6),
          {number(7), number(8), number(9)},
          columns_[10] ? columns_[10].raw_at(row) : ByteSpan()};
}

Feature FeaturesView::operator[](std::uint32_t index) const noexcept {
  if (index >= size()) return {};
  const RecordView& record = record_with(*table_, index);
  return Columns(record).feature(index - record.first_row());
}

std::string_view SignatureView::label() const noexcept {
  const flatbuffers::String* const label = core_->signature->label();
  return label == nullptr ? std::string_view() : label->string_view();
}

std::optional<RigidTransform> SignatureView::T_map_base() const noexcept {
  return transform_of(core_->signature->pose());
}
std::optional<RigidTransform> SignatureView::T_odom_base() const noexcept {
  return transform_of(core_->signature->odometry_pose());
}
std::optional<RigidTransform> SignatureView::T_world_base() const noexcept {
  return transform_of(core_->signature->ground_truth_pose());
}

ByteSpan SignatureView::bytes_of(const flatbuffers::Vector<std::uint8_t>* vector) noexcept {
  if (vector == nullptr) return {};
  return {reinterpret_cast<const std::byte*>(vector->data()), vector->size()};
}

ByteSpan SignatureView::calibration() const noexcept {
  const std::uint32_t place = core_->signature->calibration();
  constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  if (place == kNone) return {};
  return bytes_of(core_->chunk->calibrations()->Get(place)->data());
}

LinkView SignatureView::link_of(const fb::Link& link, const fb::CoreChunk& chunk) noexcept {
  constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  LinkView out{link.to(), link.type(), std::nullopt, {}};
  if (link.has_transform() != 0) out.T_from_to = transform_of(&link.transform());
  if (link.information() != kNone) {
    out.information = {
        reinterpret_cast<const double*>(chunk.informations()->Get(link.information())), 36};
  }
  return out;
}

std::optional<ScanView> SignatureView::scan() const noexcept {
  const auto info = info_of<ScanInfo>(zone_->table(ordinal_, fb::Part::Scan));
  if (!info) return std::nullopt;
  return ScanView{info->format,     info->range_min,   info->range_max,
                  info->angle_min,  info->angle_max,   info->angle_increment,
                  info->max_points, info->T_base_scan, rows(fb::Part::Scan)};
}

std::optional<GridView> SignatureView::grid() const noexcept {
  const auto info = info_of<GridInfo>(zone_->table(ordinal_, fb::Part::GridInfo));
  if (!info) return std::nullopt;
  return GridView{info->cell, info->view_point, rows(fb::Part::GroundCells),
                  rows(fb::Part::ObstacleCells), rows(fb::Part::EmptyCells)};
}

std::optional<SignatureView> ZoneSignatures::find(SignatureId id) const noexcept {
  std::uint32_t first = 0, count = size();
  while (count > 0) {
    const std::uint32_t half = count / 2;
    if ((*this)[first + half].id() < id) {
      first += half + 1;
      count -= half + 1;
    } else {
      count = half;
    }
  }
  if (first == size() || (*this)[first].id() != id) return std::nullopt;
  return (*this)[first];
}

}  // namespace zonepack
