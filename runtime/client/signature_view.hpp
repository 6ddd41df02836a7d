// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "runtime/client/block_view.hpp"
#include "runtime/client/table_rows.hpp"
#include "runtime/pack_format/ids.hpp"
#include "runtime/pack_format/zone_view.hpp"

// A loaded zone's signatures as a program reads them. Valid as long as the ZoneView below; an index
// beyond a size() gives empty values.
//
// Units: metres, radians, seconds since the epoch of the map's source; frames as FORMAT.md has them
// (T_map_base takes points of the robot's base to the map).
// Threads: immutable.
// Real-time: nothing allocates.
namespace zonepack {

// Row-major 3x4: rotation and translation.
using RigidTransform = std::array<float, 12>;

struct LinkView {
  std::int32_t to = 0;    // a signature's id; negative: a landmark's
  std::int32_t type = 0;  // the source's number (FORMAT.md)
  std::optional<RigidTransform> T_from_to;
  std::span<const double> information;  // 6x6, row-major, x y z roll pitch yaw; or empty
};

struct Feature {
  float x_px = 0, y_px = 0, size_px = 0;
  float angle = 0, response = 0;  // as the detector gave them
  std::int32_t octave = 0;
  std::int32_t word_id = 0;       // <= 0: not in the source's dictionary
  std::array<float, 3> p_base{};  // NaN where unknown
  ByteSpan descriptor;            // in place: valid until read() returns
};

enum class DescriptorType : std::uint8_t { kNone, kU8, kF32 };

class FeaturesView {
 public:
  explicit FeaturesView(const TableView* table) noexcept : table_(table) {}

  std::uint32_t size() const noexcept { return table_ == nullptr ? 0 : table_->total_rows(); }
  DescriptorType descriptor_type() const noexcept;
  std::uint32_t descriptor_dim() const noexcept;  // elements per descriptor

  Feature operator[](std::uint32_t index) const noexcept;

  // Calls fn(const Feature&) for each, in order; faster than indexing.
  template <typename Fn>
  void for_each(Fn&& fn) const {
    if (table_ == nullptr) return;
    for (const RecordView& record : table_->records()) {
      const Columns columns(record);
      for (std::uint32_t row = 0; row < record.rows(); ++row) fn(columns.feature(row));
    }
  }

 private:
  class Columns {
   public:
    explicit Columns(const RecordView& record) noexcept;
    Feature feature(std::uint32_t row) const noexcept;

   private:
    std::array<ColumnView, 11> columns_;  // from Field::X to Field::Descriptor
  };
  std::uint64_t info() const noexcept;

  const TableView* table_;
};

struct ScanView {
  std::int32_t format = 0;  // RTAB-Map's number, 1 to 12; 0: unknown
  float range_min_m = 0, range_max_m = 0;
  float angle_min = 0, angle_max = 0, angle_increment = 0;
  float max_points = 0;
  RigidTransform T_base_scan{};
  TableRows points;  // in the scan's frame
};

struct GridView {
  float cell_m = 0;
  std::array<float, 3> view_point{};
  TableRows ground, obstacles, empty;  // cells in the base frame: x, y and, in 3D, more
};

class SignatureView {
 public:
  SignatureView(const ZoneView& zone, std::uint32_t ordinal) noexcept
      : zone_(&zone), core_(&zone.core(ordinal)), ordinal_(ordinal) {}

  SignatureId id() const noexcept { return core_->signature->id(); }
  std::int32_t map_id() const noexcept { return core_->signature->map_id(); }  // mapping session
  std::int32_t weight() const noexcept { return core_->signature->weight(); }
  double stamp_s() const noexcept { return core_->signature->stamp(); }
  std::string_view label() const noexcept;

  std::optional<RigidTransform> T_map_base() const noexcept;
  std::optional<RigidTransform> T_odom_base() const noexcept;
  std::optional<RigidTransform> T_world_base() const noexcept;  // ground truth, of simulated maps

  // As the source stored them; empty: none.
  ByteSpan calibration() const noexcept;
  ByteSpan velocity() const noexcept { return bytes_of(core_->signature->velocity()); }
  ByteSpan gps() const noexcept { return bytes_of(core_->signature->gps()); }
  ByteSpan env_sensors() const noexcept { return bytes_of(core_->signature->env_sensors()); }

  // Calls fn(const LinkView&) for each link, in the source's order.
  template <typename Fn>
  void for_each_link(Fn&& fn) const {
    for_each_link_in(*core_->signature, *core_->chunk, fn);
    for (const ZoneView::More& more : core_->more_links) {
      for_each_link_in(*more.signature, *more.chunk, fn);
    }
  }

  FeaturesView features() const noexcept {
    return FeaturesView(zone_->table(ordinal_, fb::Part::Features));
  }
  std::optional<ScanView> scan() const noexcept;
  std::optional<GridView> grid() const noexcept;
  // Any other payload, by its part: images, depth, user data.
  TableRows rows(fb::Part part) const noexcept {
    return TableRows(zone_->table(ordinal_, part), zone_->table(ordinal_, fb::Part::Scan));
  }
  // All tables, for parts that a signature has several of; TableView::ordinal() says which.
  std::span<const TableView> tables() const noexcept { return zone_->tables(ordinal_); }

 private:
  static ByteSpan bytes_of(const flatbuffers::Vector<std::uint8_t>* vector) noexcept;
  static LinkView link_of(const fb::Link& link, const fb::CoreChunk& chunk) noexcept;

  template <typename Fn>
  static void for_each_link_in(const fb::Signature& entry, const fb::CoreChunk& chunk, Fn&& fn) {
    if (entry.links() == nullptr) return;
    for (const fb::Link* const link : *entry.links()) fn(link_of(*link, chunk));
  }

  const ZoneView* zone_;
  const ZoneView::Core* core_;
  std::uint32_t ordinal_;
};

// The signatures of one zone, in order of their ids.
class ZoneSignatures {
 public:
  explicit ZoneSignatures(const ZoneView& zone) noexcept : zone_(&zone) {}

  std::uint32_t size() const noexcept { return zone_->size(); }
  // `index` is below size().
  SignatureView operator[](std::uint32_t index) const noexcept { return {*zone_, index}; }
  // Takes log2(size()) steps.
  std::optional<SignatureView> find(SignatureId id) const noexcept;
  // Blocks of voxels, of maps that hold them (nvblox).
  BlocksView blocks() const noexcept { return BlocksView(*zone_); }
  const ZoneView& zone() const noexcept { return *zone_; }

 private:
  const ZoneView* zone_;
};

}  // namespace zonepack
