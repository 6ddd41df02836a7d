// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/runtime/client/record_from_view.hpp"

#include <cstring>

namespace zonepack::test_support {
namespace {

packer::Bytes copy(ByteSpan bytes) { return {bytes.begin(), bytes.end()}; }

packer::Bytes all_rows(const TableRows& rows) {
  packer::Bytes out;
  rows.for_each([&](ByteSpan row) { out.insert(out.end(), row.begin(), row.end()); });
  return out;
}

packer::Bytes all_pieces(const TableRows& rows) {
  packer::Bytes out;
  rows.for_each_piece([&](ByteSpan piece) { out.insert(out.end(), piece.begin(), piece.end()); });
  return out;
}

packer::Matrix matrix(const TableRows& rows) {
  static constexpr std::size_t kElementBytes[] = {1, 1, 2, 2, 4, 4, 8, 2};
  packer::Matrix out{rows.matrix_rows(), 0, rows.matrix_type(), all_rows(rows)};
  const std::size_t line = static_cast<std::size_t>(out.rows) * kElementBytes[out.type & 7] *
                           static_cast<std::size_t>((out.type >> 3) + 1);
  if (line != 0) out.cols = static_cast<std::int32_t>(out.data.size() / line);
  return out;
}

std::optional<packer::Matrix> matrix_or_none(const TableRows& rows) {
  if (!rows.present()) return std::nullopt;
  return matrix(rows);
}

packer::Features features_from(const FeaturesView& view) {
  packer::Features out;
  out.count = view.size();
  out.descriptor_type = static_cast<packer::Features::DescriptorType>(view.descriptor_type());
  out.descriptor_dim = view.descriptor_dim();
  view.for_each([&](const Feature& f) {
    out.x.push_back(f.x_px), out.y.push_back(f.y_px), out.size.push_back(f.size_px);
    out.angle.push_back(f.angle), out.response.push_back(f.response);
    out.octave.push_back(f.octave), out.word_id.push_back(f.word_id);
    out.point_x.push_back(f.p_base[0]), out.point_y.push_back(f.p_base[1]);
    out.point_z.push_back(f.p_base[2]);
    out.descriptors.insert(out.descriptors.end(), f.descriptor.begin(), f.descriptor.end());
  });
  return out;
}

template <typename T>
T read(ByteSpan bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

packer::GlobalDescriptor global_from(const TableView& table) {
  const ByteSpan info = table.attribute(fb::Field::Info).bytes();
  packer::GlobalDescriptor out;
  out.type = read<std::int32_t>(info, 0);
  if (info.size() >= 20 && read<std::int32_t>(info, 4) != 0) {
    out.info = packer::Matrix{read<std::int32_t>(info, 8), read<std::int32_t>(info, 12),
                              read<std::int32_t>(info, 16), copy(info.subspan(20))};
  }
  out.data = matrix(TableRows(&table));
  return out;
}

}  // namespace

packer::SignatureRecord record_from(const SignatureView& s) {
  packer::SignatureRecord out;
  out.id = s.id(), out.map_id = s.map_id(), out.weight = s.weight(), out.stamp = s.stamp_s();
  out.label = s.label();
  out.pose = s.T_map_base(), out.odometry_pose = s.T_odom_base();
  out.ground_truth_pose = s.T_world_base();
  out.velocity = copy(s.velocity()), out.gps = copy(s.gps());
  out.env_sensors = copy(s.env_sensors()), out.calibration = copy(s.calibration());
  out.features = features_from(s.features());
  if (const auto scan = s.scan()) {
    out.scan = packer::Scan{scan->format,     scan->range_min_m, scan->range_max_m,
                            scan->angle_min,  scan->angle_max,   scan->angle_increment,
                            scan->max_points, scan->T_base_scan, matrix(scan->points)};
  }
  if (const auto grid = s.grid()) {
    out.grid = packer::Grid{grid->cell_m, grid->view_point, matrix_or_none(grid->ground),
                            matrix_or_none(grid->obstacles), matrix_or_none(grid->empty)};
  }
  out.image = all_pieces(s.rows(fb::Part::Image));
  out.depth = all_pieces(s.rows(fb::Part::Depth));
  out.depth_confidence = all_pieces(s.rows(fb::Part::DepthConfidence));
  out.user_data = matrix_or_none(s.rows(fb::Part::UserData));
  s.for_each_link([&](const LinkView& link) {
    out.links.push_back({link.to,
                         link.type,
                         link.T_from_to,
                         {link.information.begin(), link.information.end()},
                         std::nullopt});
  });
  for (const TableView& table : s.tables()) {
    if (table.part() == fb::Part::GlobalDescriptor) {
      out.global_descriptors.push_back(global_from(table));
    } else if (table.part() == fb::Part::LinkUserData) {
      out.links.at(table.ordinal()).user_data = matrix(TableRows(&table));
    }
  }
  return out;
}

}  // namespace zonepack::test_support
