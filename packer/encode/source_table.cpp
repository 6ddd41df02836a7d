// SPDX-License-Identifier: Apache-2.0
#include "packer/encode/source_table.hpp"

#include <cstring>
#include <utility>

#include "packer/encode/voxel_encoder.hpp"
#include "packer/record/append_value.hpp"
#include "runtime/pack_format/block_index.hpp"

namespace zonepack::packer {
namespace {

constexpr std::int32_t kFloat = 5;  // OpenCV depth
constexpr std::uint32_t kMaxChannels = 10;

// The rows of a column as separate channels, if that is smaller than the rows themselves.
std::optional<std::vector<EncodedColumn>> by_channel(std::span<const std::byte> rows,
                                                     std::uint32_t row_bytes) {
  const std::uint32_t channels = row_bytes / 4;
  const std::size_t count = rows.size() / row_bytes;
  std::vector<EncodedColumn> columns;
  std::vector<std::uint32_t> values(count);
  std::size_t size = 0;
  for (std::uint32_t c = 0; c < channels; ++c) {
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(&values[i], rows.data() + i * row_bytes + std::size_t{c} * 4, 4);
    }
    const auto field = static_cast<fb::Field>(static_cast<std::uint16_t>(fb::Field::Channel0) + c);
    columns.push_back(encode_values(field, values));
    size += columns.back().bytes.size() + sizeof(fb::Column);
  }
  if (size >= rows.size()) return std::nullopt;
  return columns;
}

EncodedColumn shape_of(const Matrix& matrix) {
  return encode_constant(fb::Field::Shape,
                         static_cast<std::uint32_t>(matrix.rows) |
                             std::uint64_t{static_cast<std::uint32_t>(matrix.type)} << 32);
}

std::uint32_t channels_of(const Matrix& matrix) {
  return static_cast<std::uint32_t>(matrix.type >> 3) + 1;
}

SourceTable bytes_table(std::uint32_t signature, fb::Part part, Bytes bytes) {
  SourceTable table{signature, part, 0, static_cast<std::uint32_t>(bytes.size()), {}, {}, 0, {}};
  table.columns.push_back({fb::Field::Row, 1, false, std::move(bytes)});
  return table;
}

// A matrix of float32 points becomes one row per point; any other matrix is a string of bytes.
SourceTable matrix_table(std::uint32_t signature, fb::Part part, Matrix matrix, bool points) {
  const EncodedColumn shape = shape_of(matrix);
  const std::uint32_t row_bytes = channels_of(matrix) * 4;
  SourceTable table = bytes_table(signature, part, std::move(matrix.data));
  table.attributes.push_back(shape);
  if (points && (matrix.type & 7) == kFloat && row_bytes <= kMaxChannels * 4) {
    table.columns[0].row_bytes = row_bytes;
    table.rows /= row_bytes;
  }
  return table;
}

template <typename T>
SourceColumn values_column(fb::Field field, const std::vector<T>& values) {
  static_assert(sizeof(T) == 4);
  SourceColumn column{field, 4, true, Bytes(values.size() * 4)};
  if (!values.empty()) std::memcpy(column.data.data(), values.data(), column.data.size());
  return column;
}

SourceTable features_table(std::uint32_t signature, Features& features) {
  SourceTable table{
      signature, fb::Part::Features, 0, static_cast<std::uint32_t>(features.count), {}, {}, 0, {}};
  const bool is_float = features.descriptor_type == Features::DescriptorType::kF32;
  table.attributes.push_back(encode_constant(
      fb::Field::Info,
      features.descriptor_dim | static_cast<std::uint64_t>(features.descriptor_type) << 32));
  table.columns.push_back(values_column(fb::Field::X, features.x));
  table.columns.push_back(values_column(fb::Field::Y, features.y));
  table.columns.push_back(values_column(fb::Field::Size, features.size));
  table.columns.push_back(values_column(fb::Field::Angle, features.angle));
  table.columns.push_back(values_column(fb::Field::Response, features.response));
  table.columns.push_back(values_column(fb::Field::Octave, features.octave));
  table.columns.push_back(values_column(fb::Field::WordId, features.word_id));
  table.columns.push_back(values_column(fb::Field::PointX, features.point_x));
  table.columns.push_back(values_column(fb::Field::PointY, features.point_y));
  table.columns.push_back(values_column(fb::Field::PointZ, features.point_z));
  if (features.descriptor_dim > 0) {
    table.columns.push_back({fb::Field::Descriptor, features.descriptor_dim * (is_float ? 4 : 1),
                             false, std::move(features.descriptors)});
  }
  return table;
}

SourceTable scan_table(std::uint32_t signature, Scan scan) {
  Bytes info;
  append_value(info, scan.format);
  for (const float v : {scan.range_min, scan.range_max, scan.angle_min, scan.angle_max,
                        scan.angle_increment, scan.max_points}) {
    append_value(info, v);
  }
  for (const float v : scan.local_transform) append_value(info, v);
  SourceTable table = matrix_table(signature, fb::Part::Scan, std::move(scan.data), true);
  const auto size = static_cast<std::uint32_t>(info.size());
  table.attributes.push_back(encode_raw(fb::Field::Info, info, size));
  return table;
}

SourceTable blocks_table(std::uint32_t signature, VoxelLayer layer, const BlockCube& cube) {
  const BlockLayer& blocks = cube.layers[static_cast<std::size_t>(layer)];
  const std::uint32_t planes = planes_of(layer);
  const std::uint32_t bytes = bytes_of_block(planes);
  SourceTable table{
      signature, part_of(layer), 0, static_cast<std::uint32_t>(blocks.place.size()), {}, {}, 0, {}};
  table.attributes.push_back(
      encode_raw(fb::Field::Info, std::as_bytes(std::span(cube.index)), sizeof cube.index));
  const std::vector<std::uint32_t> places(blocks.place.begin(), blocks.place.end());
  table.columns.push_back(values_column(fb::Field::Place, places));
  table.columns.push_back(values_column(fb::Field::SourceRow, blocks.row));
  SourceColumn voxels{fb::Field::Voxels, 0, false, {}, {}, planes};
  for (std::size_t i = 0; i < blocks.place.size(); ++i) {
    encode_block(std::span(blocks.voxels).subspan(i * bytes, bytes), planes, voxels.data);
    voxels.ends.push_back(static_cast<std::uint32_t>(voxels.data.size()));
  }
  table.columns.push_back(std::move(voxels));
  return table;
}

// Rows [first, first + count) of encoded blocks: where each ends, then the blocks. Beyond what a
// slot holds, ends wrap; such a column is never stored.
EncodedColumn encode_blocks(const SourceColumn& column, std::uint32_t first, std::uint32_t count) {
  EncodedColumn out{column.field, fb::ColumnCodec::Planes, 0, column.planes, 0, {}};
  const std::uint32_t begin = first == 0 ? 0 : column.ends[first - 1];
  for (std::uint32_t i = first; i < first + count; ++i) {
    append_value(out.bytes, static_cast<std::uint16_t>(column.ends[i] - begin));
  }
  const std::uint32_t end = count == 0 ? begin : column.ends[first + count - 1];
  out.bytes.insert(out.bytes.end(), column.data.begin() + begin, column.data.begin() + end);
  return out;
}

}  // namespace

std::vector<EncodedColumn> SourceTable::encode(std::uint32_t first, std::uint32_t count,
                                               LatticeEncoder& lattice) const {
  std::vector<EncodedColumn> out;
  if (first == 0) out = attributes;
  for (const SourceColumn& column : columns) {
    if (column.planes != 0) {
      out.push_back(encode_blocks(column, first, count));
      continue;
    }
    const auto rows_bytes =
        std::span<const std::byte>(column.data)
            .subspan(std::size_t{first} * column.row_bytes, std::size_t{count} * column.row_bytes);
    if (column.values) {
      std::vector<std::uint32_t> values(count);
      if (count > 0) std::memcpy(values.data(), rows_bytes.data(), rows_bytes.size());
      out.push_back(encode_values(column.field, values));
      continue;
    }
    if (scan_indices && count > 0) {
      const EncodedColumn subset =
          encode_subset(column.field, std::span(*scan_indices).subspan(first, count));
      if (subset.bytes.size() < rows_bytes.size()) {
        out.push_back(subset);
        continue;
      }
    }
    if (cell_size > 0 && column.row_bytes == 8) {
      if (auto cells = lattice.encode(rows_bytes, cell_size)) {
        out.push_back(std::move(*cells));
        continue;
      }
    }
    const bool points = column.field == fb::Field::Row && column.row_bytes >= 8;
    if (points && count > 0) {
      if (auto channels = by_channel(rows_bytes, column.row_bytes)) {
        for (EncodedColumn& channel : *channels) out.push_back(std::move(channel));
        continue;
      }
    }
    out.push_back(encode_raw(column.field, rows_bytes, column.row_bytes));
  }
  return out;
}

std::uint32_t SourceTable::rows_within(std::uint32_t first, std::uint64_t bytes) const {
  if (!of_blocks()) return rows - first;
  const std::vector<std::uint32_t>& ends = columns.back().ends;
  const std::uint64_t begin = first == 0 ? 0 : ends[first - 1];
  std::uint32_t count = 0;
  while (first + count < rows &&
         ends[first + count] - begin + 2 * (std::uint64_t{count} + 1) <= bytes) {
    ++count;
  }
  return count;
}

std::vector<SourceTable> tables_of(SignatureRecord& record, std::uint32_t ordinal) {
  std::vector<SourceTable> tables;
  if (record.features.count > 0) tables.push_back(features_table(ordinal, record.features));
  for (std::size_t i = 0; i < record.global_descriptors.size(); ++i) {
    GlobalDescriptor& descriptor = record.global_descriptors[i];
    Bytes info;
    append_value(info, descriptor.type);
    append_value(info, std::int32_t{descriptor.info.has_value()});
    if (descriptor.info) {
      append_value(info, descriptor.info->rows);
      append_value(info, descriptor.info->cols);
      append_value(info, descriptor.info->type);
      info.insert(info.end(), descriptor.info->data.begin(), descriptor.info->data.end());
    }
    tables.push_back(
        matrix_table(ordinal, fb::Part::GlobalDescriptor, std::move(descriptor.data), false));
    tables.back().ordinal = static_cast<std::uint16_t>(i);
    const auto size = static_cast<std::uint32_t>(info.size());
    tables.back().attributes.push_back(encode_raw(fb::Field::Info, info, size));
  }
  if (record.grid) {
    const Grid& grid = *record.grid;
    SourceTable info{ordinal, fb::Part::GridInfo, 0, 0, {}, {}, 0, {}};
    Bytes values;
    append_value(values, grid.cell_size);
    for (const float v : grid.view_point) append_value(values, v);
    info.attributes.push_back(encode_raw(fb::Field::Info, values, 16));
    tables.push_back(std::move(info));
    const std::pair<fb::Part, std::optional<Matrix>*> parts[] = {
        {fb::Part::GroundCells, &record.grid->ground},
        {fb::Part::ObstacleCells, &record.grid->obstacle},
        {fb::Part::EmptyCells, &record.grid->empty}};
    for (const auto& [part, matrix] : parts) {
      if (!matrix->has_value()) continue;
      const std::int32_t type = (*matrix)->type;
      tables.push_back(matrix_table(ordinal, part, std::move(**matrix), true));
      SourceTable& table = tables.back();
      table.cell_size = grid.cell_size;
      const std::uint32_t row_bytes = table.columns[0].row_bytes;
      if (row_bytes >= 8 && record.scan && record.scan->data.type == type) {
        table.scan_indices = subset_of(table.columns[0].data, record.scan->data.data, row_bytes);
      }
    }
  }
  if (record.scan) tables.push_back(scan_table(ordinal, std::move(*record.scan)));
  const auto add_bytes = [&](fb::Part part, Bytes& bytes) {
    if (!bytes.empty()) tables.push_back(bytes_table(ordinal, part, std::move(bytes)));
  };
  add_bytes(fb::Part::Image, record.image);
  add_bytes(fb::Part::Depth, record.depth);
  add_bytes(fb::Part::DepthConfidence, record.depth_confidence);
  if (record.user_data) {
    tables.push_back(
        matrix_table(ordinal, fb::Part::UserData, std::move(*record.user_data), false));
  }
  if (record.blocks) {
    add_bytes(fb::Part::BlockLayers, record.blocks->layers_info);
    for (std::uint32_t i = 0; i < kVoxelLayers; ++i) {
      if (record.blocks->layers[i].place.empty()) continue;
      tables.push_back(blocks_table(ordinal, static_cast<VoxelLayer>(i), *record.blocks));
    }
    record.blocks.reset();
  }
  for (std::size_t i = 0; i < record.links.size(); ++i) {
    if (!record.links[i].user_data) continue;
    tables.push_back(matrix_table(ordinal, fb::Part::LinkUserData,
                                  std::move(*record.links[i].user_data), false));
    tables.back().ordinal = static_cast<std::uint16_t>(i);
  }
  return tables;
}

}  // namespace zonepack::packer
