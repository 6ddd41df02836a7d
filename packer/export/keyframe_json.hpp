// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "packer/export/json_lines.hpp"
#include "packer/record/record.hpp"
#include "runtime/pack_format/chunk_view.hpp"

namespace zonepack::packer {

// Writes one keyframe of a stella_vslam map as one line, in that program's own terms: zone,
// keyframe, ts, pose (T_map_base), undist_keypts [x, y, size, angle, response, octave], lm_ids (-1:
// none), points (of the landmarks, in the base frame), descs (base64, 32 bytes each), calibration,
// span_parent (-1: none), loop_edges. What was not packed is null.
void write_keyframe(JsonLines& json, std::string_view zone, const SignatureRecord& record,
                    PayloadMask packed);

}  // namespace zonepack::packer
