// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "packer/record/record.hpp"
#include "packer/sources/damage.hpp"
#include "packer/sources/keyed_rows.hpp"
#include "packer/sources/rtabmap_schema.hpp"

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
