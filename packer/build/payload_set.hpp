// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "packer/record/record.hpp"
#include "runtime/pack_format/file/pack_file.hpp"

namespace zonepack::packer {

// What a source is asked for, so that these kinds can be packed.
constexpr PayloadSet payload_set(PayloadMask mask) {
  const auto has = [mask](fb::PayloadKind kind) { return (mask & mask_of(kind)) != 0; };
  return {has(fb::PayloadKind::Features), has(fb::PayloadKind::Scan),
          has(fb::PayloadKind::Grid),     has(fb::PayloadKind::Image),
          has(fb::PayloadKind::Depth),    has(fb::PayloadKind::UserData),
          has(fb::PayloadKind::Blocks)};
}

// The minor version of packs that hold these kinds.
constexpr std::uint16_t pack_minor(PayloadMask packed) {
  return (packed & mask_of(fb::PayloadKind::Blocks)) != 0 ? kPackMinorOfBlocks : 0;
}

}  // namespace zonepack::packer
