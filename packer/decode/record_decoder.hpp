// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "packer/record/record.hpp"
#include "runtime/pack_format/zone_view.hpp"

namespace zonepack::packer {

// Restores a signature to what it was before packing, bit for bit, as far as the view's chunks hold
// it: payload kinds that were not decoded or packed are empty. Throws std::runtime_error naming the
// signature when its tables contradict each other (a damaged pack with valid checksums).
SignatureRecord decode_record(const ZoneView& zone, std::uint32_t ordinal);

}  // namespace zonepack::packer
