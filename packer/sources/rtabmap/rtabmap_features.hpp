// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "packer/record/damage.hpp"
#include "packer/record/record.hpp"
#include "packer/sources/rtabmap/rtabmap_schema.hpp"
#include "packer/sources/sqlite/keyed_rows.hpp"

namespace zonepack::packer {

// Reads the keypoints of one signature at a time.
class FeatureReader {
 public:
  FeatureReader(const SqliteFile& file, const RtabmapSchema& schema);

  // Replaces `out`, keeping its memory. `place` names the file and signature.
  void read(const CellPlace& place, Features& out);

 private:
  void append_descriptor(const CellPlace& place, Features& out);

  KeyedRows rows_;
  bool has_octave_;
};

}  // namespace zonepack::packer
