// SPDX-License-Identifier: Apache-2.0
#include "packer/decode/record_decoder.hpp"

#include <cstring>
#include <stdexcept>
#include <string>

#include "packer/record/append_value.hpp"
#include "runtime/pack_format/block_index.hpp"

namespace zonepack::packer {
namespace {

using fb::ColumnCodec;
using fb::Field;
using fb::Part;

Bytes to_bytes(const flatbuffers::Vector<std::uint8_t>* vector) {
  if (vector == nullptr) return {};
  const auto* const begin = reinterpret_cast<const std::byte*>(vector->data());
  return {begin, begin + vector->size()};
}

std::optional<Transform> to_transform(const fb::Transform* transform) {
  if (transform == nullptr) return std::nullopt;
  Transform out;
  std::memcpy(out.data(), transform, sizeof out);
  return out;
}

template <typename T>
T read(ByteSpan bytes, std::size_t offset) {
  if (bytes.size() < sizeof(T) || offset > bytes.size() - sizeof(T)) {
    throw std::runtime_error("an Info attribute is too short");
  }
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

class SignatureDecoder {
 public:
  SignatureDecoder(const ZoneView& zone, std::uint32_t ordinal) : zone_(zone), ordinal_(ordinal) {}

  SignatureRecord decode() {
    decode_core();
    for (const TableView& table : zone_.tables(ordinal_)) decode_table(table);
    return std::move(record_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error("signature " + std::to_string(zone_.core(ordinal_).signature->id()) +
                             ": " + what);
  }

  void decode_core() {
    const ZoneView::Core& core = zone_.core(ordinal_);
    const fb::Signature& s = *core.signature;
    record_.id = s.id();
    record_.map_id = s.map_id();
    record_.weight = s.weight();
    record_.stamp = s.stamp();
    if (s.label() != nullptr) record_.label = s.label()->str();
    record_.pose = to_transform(s.pose());
    record_.odometry_pose = to_transform(s.odometry_pose());
    record_.ground_truth_pose = to_transform(s.ground_truth_pose());
    record_.velocity = to_bytes(s.velocity());
    record_.gps = to_bytes(s.gps());
    record_.env_sensors = to_bytes(s.env_sensors());
    if (s.calibration() != 0xFFFFFFFFu) {
      record_.calibration = to_bytes(core.chunk->calibrations()->Get(s.calibration())->data());
    }
    decode_links(s, *core.chunk);
    for (const ZoneView::More& more : core.more_links) decode_links(*more.signature, *more.chunk);
  }

  void decode_links(const fb::Signature& s, const fb::CoreChunk& chunk) {
    if (s.links() == nullptr) return;
    for (const fb::Link* link : *s.links()) {
      Link& out = record_.links.emplace_back();
      out.to = link->to();
      out.type = link->type();
      if (link->has_transform() != 0) out.transform = to_transform(&link->transform());
      if (link->information() != 0xFFFFFFFFu) {
        out.information.resize(36);
        std::memcpy(out.information.data(), chunk.informations()->Get(link->information()),
                    sizeof(fb::Information));
      }
    }
  }

  // All rows of a table in their original form; sets row_bytes to the size of one.
  Bytes rows_of(const TableView& table, Field field, std::uint32_t* row_bytes) {
    Bytes out;
    for (const RecordView& record : table.records()) {
      if (const ColumnView column = record.column(field)) {
        append_rows(record, column, out, row_bytes);
      } else if (record.column(Field::Channel0)) {
        append_channels(record, out, row_bytes);
      } else {
        fail("a table has no column of rows");
      }
    }
    return out;
  }

  void append_rows(const RecordView& record, const ColumnView& column, Bytes& out,
                   std::uint32_t* row_bytes) {
    switch (column.codec()) {
      case ColumnCodec::Raw:
        *row_bytes = column.param();
        out.insert(out.end(), column.bytes().begin(), column.bytes().end());
        return;
      case ColumnCodec::Lattice:
        *row_bytes = 8;
        for_each_cell(column, [&](float x, float y) {
          const float xy[2] = {x, y};
          const auto bytes = std::as_bytes(std::span(xy));
          out.insert(out.end(), bytes.begin(), bytes.end());
        });
        return;
      case ColumnCodec::Subset:
        append_subset(column, out, row_bytes);
        return;
      default:
        fail("rows of part " + std::to_string(static_cast<int>(record.part())) +
             " have a codec that gives single values");
    }
  }

  void append_subset(const ColumnView& column, Bytes& out, std::uint32_t* row_bytes) {
    const TableView* const scan = zone_.table(ordinal_, Part::Scan);
    if (scan == nullptr) fail("grid cells refer to a scan that is not there");
    if (scan_rows_.empty()) scan_rows_ = rows_of(*scan, Field::Row, &scan_row_bytes_);
    *row_bytes = scan_row_bytes_;
    const std::size_t points = scan_row_bytes_ == 0 ? 0 : scan_rows_.size() / scan_row_bytes_;
    for_each_scan_index(column, [&](std::uint32_t index) {
      if (index >= points) fail("grid cells refer to points beyond the scan");
      const auto begin =
          scan_rows_.begin() + static_cast<std::ptrdiff_t>(index * std::size_t{scan_row_bytes_});
      out.insert(out.end(), begin, begin + scan_row_bytes_);
    });
  }

  void append_channels(const RecordView& record, Bytes& out, std::uint32_t* row_bytes) {
    std::vector<ColumnView> channels;
    for (auto field = static_cast<std::uint16_t>(Field::Channel0);
         field <= static_cast<std::uint16_t>(Field::MAX); ++field) {
      const ColumnView column = record.column(static_cast<Field>(field));
      if (!column) break;
      channels.push_back(column);
    }
    *row_bytes = static_cast<std::uint32_t>(channels.size() * 4);
    for (std::uint32_t row = 0; row < record.rows(); ++row) {
      for (const ColumnView& channel : channels) {
        append_value(out, channel.bits_at(row));
      }
    }
  }

  Matrix matrix_of(const TableView& table) {
    const ColumnView shape = table.attribute(Field::Shape);
    if (!shape || shape.codec() != ColumnCodec::Constant) fail("a matrix has no shape");
    Matrix matrix;
    matrix.rows = static_cast<std::int32_t>(shape.base());
    matrix.type = static_cast<std::int32_t>(shape.base() >> 32);
    std::uint32_t row_bytes = 0;
    matrix.data = rows_of(table, Field::Row, &row_bytes);
    static constexpr std::size_t kElementBytes[] = {1, 1, 2, 2, 4, 4, 8, 2};
    const std::size_t line = static_cast<std::size_t>(matrix.rows < 0 ? 0 : matrix.rows) *
                             kElementBytes[matrix.type & 7] *
                             static_cast<std::size_t>((matrix.type >> 3) + 1);
    if (line != 0) matrix.cols = static_cast<std::int32_t>(matrix.data.size() / line);
    if (matrix.type < 0 || (line == 0 ? !matrix.data.empty() : matrix.data.size() % line != 0)) {
      fail("a matrix does not have the size of its shape");
    }
    return matrix;
  }

  Bytes blob_of(const TableView& table) {
    std::uint32_t row_bytes = 0;
    return rows_of(table, Field::Row, &row_bytes);
  }

  ByteSpan info_of(const TableView& table) {
    const ColumnView info = table.attribute(Field::Info);
    if (!info || info.codec() != ColumnCodec::Raw) fail("a table has no Info");
    return info.bytes();
  }

  void decode_table(const TableView& table) {
    switch (table.part()) {
      case Part::Features:
        decode_features(table);
        return;
      case Part::GlobalDescriptor:
        decode_global_descriptor(table);
        return;
      case Part::Scan:
        decode_scan(table);
        return;
      case Part::GridInfo: {
        const ByteSpan info = info_of(table);
        Grid& out = grid();
        out.cell_size = read<float>(info, 0);
        for (std::size_t i = 0; i < 3; ++i) out.view_point[i] = read<float>(info, 4 + 4 * i);
        return;
      }
      case Part::GroundCells:
        grid().ground = matrix_of(table);
        return;
      case Part::ObstacleCells:
        grid().obstacle = matrix_of(table);
        return;
      case Part::EmptyCells:
        grid().empty = matrix_of(table);
        return;
      case Part::Image:
        record_.image = blob_of(table);
        return;
      case Part::Depth:
        record_.depth = blob_of(table);
        return;
      case Part::DepthConfidence:
        record_.depth_confidence = blob_of(table);
        return;
      case Part::UserData:
        record_.user_data = matrix_of(table);
        return;
      case Part::LinkUserData:
        if (table.ordinal() >= record_.links.size()) fail("user data of a link that is not there");
        record_.links[table.ordinal()].user_data = matrix_of(table);
        return;
      case Part::BlockLayers:
        blocks().layers_info = blob_of(table);
        return;
      case Part::TsdfBlocks:
      case Part::ColorBlocks:
      case Part::OccupancyBlocks:
      case Part::EsdfBlocks:
        decode_blocks(table, *voxel_layer_of(table.part()));
        return;
    }
  }

  BlockCube& blocks() {
    if (!record_.blocks) record_.blocks.emplace();
    return *record_.blocks;
  }

  // Places and plane counts were checked when the zone's index of blocks was made.
  void decode_blocks(const TableView& table, VoxelLayer layer) {
    BlockCube& cube = blocks();
    for (std::size_t i = 0; i < 3; ++i) {
      cube.index[i] = read<std::int32_t>(info_of(table), 4 * i);
    }
    BlockLayer& out = cube.layers[static_cast<std::size_t>(layer)];
    const std::uint32_t planes = planes_of(layer);
    for (const RecordView& record : table.records()) {
      const ColumnView places = record.column(Field::Place), rows = record.column(Field::SourceRow);
      const ColumnView voxels = record.column(Field::Voxels);
      for (std::uint32_t i = 0; i < record.rows(); ++i) {
        out.place.push_back(static_cast<std::uint16_t>(places.bits_at(i)));
        out.row.push_back(rows.bits_at(i));
        const std::size_t at = out.voxels.size();
        out.voxels.resize(at + bytes_of_block(planes));
        if (!copy_block(block_at(voxels.bytes(), record.rows(), i), planes,
                        std::span(out.voxels).subspan(at))) {
          fail("a block of voxels is not whole");
        }
      }
    }
  }

  Grid& grid() {
    if (!record_.grid) record_.grid.emplace();
    return *record_.grid;
  }

  void decode_features(const TableView& table) {
    Features& out = record_.features;
    const ColumnView info = table.attribute(Field::Info);
    if (!info || info.codec() != ColumnCodec::Constant || info.base() >> 32 > 2) {
      fail("features have no descriptor type");
    }
    out.count = table.total_rows();
    out.descriptor_dim = static_cast<std::uint32_t>(info.base());
    out.descriptor_type = static_cast<Features::DescriptorType>(info.base() >> 32);
    for (const RecordView& record : table.records()) {
      const auto floats = [&](Field field, std::vector<float>& values) {
        const ColumnView column = value_column(record, field);
        for (std::uint32_t i = 0; i < record.rows(); ++i) values.push_back(column.float_at(i));
      };
      const auto ints = [&](Field field, std::vector<std::int32_t>& values) {
        const ColumnView column = value_column(record, field);
        for (std::uint32_t i = 0; i < record.rows(); ++i) values.push_back(column.int_at(i));
      };
      floats(Field::X, out.x);
      floats(Field::Y, out.y);
      floats(Field::Size, out.size);
      floats(Field::Angle, out.angle);
      floats(Field::Response, out.response);
      ints(Field::Octave, out.octave);
      ints(Field::WordId, out.word_id);
      floats(Field::PointX, out.point_x);
      floats(Field::PointY, out.point_y);
      floats(Field::PointZ, out.point_z);
    }
    if (out.descriptor_dim == 0) return;
    std::uint32_t row_bytes = 0;
    out.descriptors = rows_of(table, Field::Descriptor, &row_bytes);
    const bool is_float = out.descriptor_type == Features::DescriptorType::kF32;
    if (out.descriptors.size() != out.count * out.descriptor_dim * (is_float ? 4 : 1)) {
      fail("descriptors do not have the declared length");
    }
  }

  ColumnView value_column(const RecordView& record, Field field) {
    const ColumnView column = record.column(field);
    if (!column || (column.codec() == ColumnCodec::Raw && column.param() != 4) ||
        column.codec() == ColumnCodec::Lattice || column.codec() == ColumnCodec::Subset) {
      fail("features lack the values of field " + std::to_string(static_cast<int>(field)));
    }
    return column;
  }

  void decode_scan(const TableView& table) {
    const ByteSpan info = info_of(table);
    Scan& out = record_.scan.emplace();
    out.format = read<std::int32_t>(info, 0);
    float* const values[] = {&out.range_min, &out.range_max,       &out.angle_min,
                             &out.angle_max, &out.angle_increment, &out.max_points};
    for (std::size_t i = 0; i < 6; ++i) *values[i] = read<float>(info, 4 + 4 * i);
    for (std::size_t i = 0; i < 12; ++i) out.local_transform[i] = read<float>(info, 28 + 4 * i);
    out.data = matrix_of(table);
  }

  void decode_global_descriptor(const TableView& table) {
    const ByteSpan info = info_of(table);
    GlobalDescriptor& out = record_.global_descriptors.emplace_back();
    out.type = read<std::int32_t>(info, 0);
    if (read<std::int32_t>(info, 4) != 0) {
      Matrix& matrix = out.info.emplace();
      matrix.rows = read<std::int32_t>(info, 8);
      matrix.cols = read<std::int32_t>(info, 12);
      matrix.type = read<std::int32_t>(info, 16);
      matrix.data.assign(info.begin() + 20, info.end());
    }
    out.data = matrix_of(table);
  }

  const ZoneView& zone_;
  std::uint32_t ordinal_;
  SignatureRecord record_;
  Bytes scan_rows_;
  std::uint32_t scan_row_bytes_ = 0;
};

}  // namespace

SignatureRecord decode_record(const ZoneView& zone, std::uint32_t ordinal) {
  return SignatureDecoder(zone, ordinal).decode();
}

}  // namespace zonepack::packer
