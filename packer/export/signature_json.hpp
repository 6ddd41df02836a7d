// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "packer/export/json_lines.hpp"
#include "packer/record/record.hpp"
#include "runtime/pack_format/chunk_view.hpp"

namespace zonepack::packer {

// Writes one signature as one line: the keys that the help of `zonepack export` lists, in that
// order. What the signature does not have, or what was not packed, is null; a list whose payload
// was packed may be empty.
void write_signature(JsonLines& json, std::string_view zone, const SignatureRecord& record,
                     PayloadMask packed);

}  // namespace zonepack::packer
