// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "packer/record/damage.hpp"
#include "packer/record/record.hpp"
#include "packer/sources/rtabmap/rtabmap_schema.hpp"
#include "packer/sources/rtabmap/zlib_blob.hpp"
#include "packer/sources/sqlite/keyed_rows.hpp"

namespace zonepack::packer {

// Reads the row of table Data of one signature at a time: calibration, scan, grid, images, user
// data. Does not read columns of payloads that are not wanted.
class DataReader {
 public:
  DataReader(const SqliteFile& file, const RtabmapSchema& schema, const PayloadSet& wanted);

  bool serves(const PayloadSet& wanted) const noexcept;

  // Replaces the parts of `out` that are stored in Data.
  void read(const CellPlace& place, MatrixUnpacker& unpacker, SignatureRecord& out);

 private:
  void read_images(const CellPlace& place, MatrixUnpacker& unpacker, SignatureRecord& out);
  void read_scan(const CellPlace& place, MatrixUnpacker& unpacker, std::optional<Scan>& out);
  void read_grid(const CellPlace& place, MatrixUnpacker& unpacker, std::optional<Grid>& out);
  bool read_matrix(int column, const CellPlace& place, MatrixUnpacker& unpacker,
                   std::optional<Matrix>& out);

  PayloadSet wanted_;
  SchemaVersion version_;
  KeyedRows rows_;
  Matrix scratch_;
};

}  // namespace zonepack::packer
