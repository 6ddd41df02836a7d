// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/rtabmap/rtabmap_data.hpp"

#include <utility>

#include "packer/sources/rtabmap/image_blob.hpp"
#include "packer/sources/rtabmap/rtabmap_blobs.hpp"
#include "packer/sources/sqlite/cells.hpp"

namespace zonepack::packer {
namespace {

enum Column {
  kCalibration,
  kImage,
  kDepth,
  kDepthConfidence,
  kScan,
  kScanInfo,
  kScanMaxPoints,
  kScanMaxRange,
  kGround,
  kObstacle,
  kEmpty,
  kCellSize,
  kViewPointX,
  kViewPointY,
  kViewPointZ,
  kUserData
};

std::string wanted_columns(const RtabmapSchema& schema, const PayloadSet& wanted) {
  const auto only = [](bool keep, const char* name) { return keep ? name : ""; };
  return schema.columns("Data",
                        {"calibration", only(wanted.image, "image"), only(wanted.depth, "depth"),
                         only(wanted.depth, "depth_confidence"), only(wanted.scan, "scan"),
                         only(wanted.scan, "scan_info"), only(wanted.scan, "scan_max_pts"),
                         only(wanted.scan, "scan_max_range"), only(wanted.grid, "ground_cells"),
                         only(wanted.grid, "obstacle_cells"), only(wanted.grid, "empty_cells"),
                         only(wanted.grid, "cell_size"), only(wanted.grid, "view_point_x"),
                         only(wanted.grid, "view_point_y"), only(wanted.grid, "view_point_z"),
                         only(wanted.userdata, "user_data")});
}

}  // namespace

DataReader::DataReader(const SqliteFile& file, const RtabmapSchema& schema,
                       const PayloadSet& wanted)
    : wanted_(wanted),
      version_(schema.version()),
      rows_(file, wanted_columns(schema, wanted), "Data", "id", kLargestValueBytes) {}

bool DataReader::serves(const PayloadSet& wanted) const noexcept {
  return wanted.image == wanted_.image && wanted.depth == wanted_.depth &&
         wanted.scan == wanted_.scan && wanted.grid == wanted_.grid &&
         wanted.userdata == wanted_.userdata;
}

void DataReader::read(const CellPlace& place, MatrixUnpacker& unpacker, SignatureRecord& out) {
  rows_.find(place.signature);
  if (!rows_.next()) {
    for (Bytes* bytes : {&out.calibration, &out.image, &out.depth, &out.depth_confidence}) {
      bytes->clear();
    }
    out.scan.reset();
    out.grid.reset();
    out.user_data.reset();
    return;
  }
  const CellPlace calibration = place.at("Data.calibration");
  assign(out.calibration, blob_cell(rows_.row(), kCalibration, calibration));
  check_calibration(out.calibration, version_, calibration);
  read_images(place, unpacker, out);
  read_scan(place, unpacker, out.scan);
  read_grid(place, unpacker, out.grid);
  read_matrix(kUserData, place.at("Data.user_data"), unpacker, out.user_data);
  if (rows_.next()) place.at("Data.id").damaged("expected one row, found two");
}

void DataReader::read_images(const CellPlace& place, MatrixUnpacker& unpacker,
                             SignatureRecord& out) {
  const SqliteQuery& row = rows_.row();
  assign(out.image, blob_cell(row, kImage, place.at("Data.image")));
  check_image(out.image, place.at("Data.image"));
  assign(out.depth, blob_cell(row, kDepth, place.at("Data.depth")));
  check_depth(out.depth, place.at("Data.depth"));
  const CellPlace confidence = place.at("Data.depth_confidence");
  assign(out.depth_confidence, blob_cell(row, kDepthConfidence, confidence));
  if (!out.depth_confidence.empty()) unpacker.unpack(out.depth_confidence, confidence, scratch_);
}

void DataReader::read_scan(const CellPlace& place, MatrixUnpacker& unpacker,
                           std::optional<Scan>& out) {
  const SqliteQuery& row = rows_.row();
  const CellPlace points = place.at("Data.scan");
  const auto blob = blob_cell(row, kScan, points);
  if (blob.empty()) {
    out.reset();
    return;
  }
  Matrix reused = out ? std::move(out->data) : Matrix();
  Scan& scan = out.emplace();
  scan.data = std::move(reused);
  scan.max_points = float_cell(row, kScanMaxPoints, place.at("Data.scan_max_pts"), 0);
  scan.range_max = float_cell(row, kScanMaxRange, place.at("Data.scan_max_range"), 0);
  const CellPlace info = place.at("Data.scan_info");
  parse_scan_info(blob_cell(row, kScanInfo, info), version_, info, scan);
  unpacker.unpack(blob, points, scan.data);
  check_scan(scan, points);
}

void DataReader::read_grid(const CellPlace& place, MatrixUnpacker& unpacker,
                           std::optional<Grid>& out) {
  const SqliteQuery& row = rows_.row();
  if (!out) out.emplace();
  Grid& grid = *out;
  const auto cells = [&](int column, const char* name, std::optional<Matrix>& matrix) {
    if (!read_matrix(column, place.at(name), unpacker, matrix)) return false;
    check_grid_cells(*matrix, place.at(name));
    return true;
  };
  const bool ground = cells(kGround, "Data.ground_cells", grid.ground);
  const bool obstacle = cells(kObstacle, "Data.obstacle_cells", grid.obstacle);
  const bool empty = cells(kEmpty, "Data.empty_cells", grid.empty);
  if (!ground && !obstacle && !empty) {
    out.reset();
    return;
  }
  grid.cell_size = float_cell(row, kCellSize, place.at("Data.cell_size"), 0);
  grid.view_point = {float_cell(row, kViewPointX, place.at("Data.view_point_x"), 0),
                     float_cell(row, kViewPointY, place.at("Data.view_point_y"), 0),
                     float_cell(row, kViewPointZ, place.at("Data.view_point_z"), 0)};
}

bool DataReader::read_matrix(int column, const CellPlace& place, MatrixUnpacker& unpacker,
                             std::optional<Matrix>& out) {
  const auto blob = blob_cell(rows_.row(), column, place);
  if (blob.empty()) {
    out.reset();
    return false;
  }
  if (!out) out.emplace();
  unpacker.unpack(blob, place, *out);
  return true;
}

}  // namespace zonepack::packer
