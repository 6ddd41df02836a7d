// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "packer/record/damage.hpp"
#include "packer/record/record.hpp"
#include "packer/sources/rtabmap/rtabmap_schema.hpp"
#include "packer/sources/rtabmap/zlib_blob.hpp"
#include "packer/sources/sqlite/keyed_rows.hpp"

namespace zonepack::packer {

// Reads the links that start at one signature at a time, sorted by type, then destination.
class LinkReader {
 public:
  LinkReader(const SqliteFile& file, const RtabmapSchema& schema);
  void read(const CellPlace& place, MatrixUnpacker& unpacker, std::vector<Link>& out);

 private:
  void read_information(const CellPlace& place, Link& link) const;

  KeyedRows rows_;
  bool has_variances_;  // before 0.13: two variances instead of an information matrix
};

// Reads the global descriptors of one signature at a time, in table order.
class GlobalDescriptorReader {
 public:
  GlobalDescriptorReader(const SqliteFile& file, const RtabmapSchema& schema);
  void read(const CellPlace& place, MatrixUnpacker& unpacker, std::vector<GlobalDescriptor>& out);

 private:
  KeyedRows rows_;
};

}  // namespace zonepack::packer
