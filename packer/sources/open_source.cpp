// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/open_source.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "packer/sources/cloud/cloud_kinds.hpp"
#include "packer/sources/foreign_map.hpp"
#include "packer/sources/nvblox/nvblox_kind.hpp"
#include "packer/sources/rtabmap/rtabmap_kind.hpp"
#include "packer/sources/stella/stella_kind.hpp"

namespace zonepack::packer {
namespace {

constexpr std::array kKinds = {&kRtabmapKind,  &kStellaKind, &kPcdKind,
                               &kAutowareKind, &kGlimKind,   &kNvbloxKind};

}  // namespace

std::span<const SourceKind* const> source_kinds() noexcept { return kKinds; }

std::unique_ptr<MapSource> open_source(const SourceOptions& options) {
  if (!options.kind.empty()) {
    const auto forced = std::ranges::find(kKinds, options.kind, &SourceKind::name);
    if (forced != kKinds.end()) return (*forced)->open(options);
    throw std::runtime_error("there is no kind of map named " + options.kind);
  }
  for (const SourceKind* kind : kKinds) {
    if (kind->recognises(options.path)) return kind->open(options);
  }
  if (const std::string foreign = foreign_map(options.path); !foreign.empty()) {
    throw std::runtime_error(options.name() + ": is " + foreign);
  }
  // What is none of these is refused with what was expected of the most usual one.
  return kRtabmapKind.open(options);
}

}  // namespace zonepack::packer
