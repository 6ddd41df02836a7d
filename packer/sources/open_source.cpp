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

void refuse_placement(const SourceKind& kind, const SourceOptions& options) {
  const std::string option = options.placement.first_option();
  if (option.empty() || kind.takes_placement) return;
  std::string keyframes;
  for (const SourceKind* other : kKinds) {
    if (other->takes_placement)
      keyframes += (keyframes.empty() ? "" : ", ") + std::string(other->name);
  }
  throw SourceUsageError(
      option + ": " + options.name() + " is " + kind.what +
      ", whose frame is metric and level and becomes the map's; the option is for maps of "
      "keyframes (" +
      keyframes + "). Leave it out" +
      (&kind == &kRtabmapKind && option == "--align"
           ? "; to bring its signatures into the frame of a map that is packed already, give "
             "--align to 'zonepack update'"
           : ""));
}

}  // namespace

std::span<const SourceKind* const> source_kinds() noexcept { return kKinds; }

const SourceKind* recognised_kind(const SourceOptions& options) {
  if (!options.kind.empty()) {
    const auto forced = std::ranges::find(kKinds, options.kind, &SourceKind::name);
    if (forced != kKinds.end()) return *forced;
    throw std::runtime_error("there is no kind of map named " + options.kind);
  }
  const auto found = std::ranges::find_if(
      kKinds, [&](const SourceKind* kind) { return kind->recognises(options.path); });
  return found == kKinds.end() ? nullptr : *found;
}

std::unique_ptr<MapSource> open_source(const SourceOptions& options) {
  if (const SourceKind* const kind = recognised_kind(options)) {
    refuse_placement(*kind, options);
    return kind->open(options);
  }
  if (const std::string foreign = foreign_map(options.path); !foreign.empty()) {
    throw std::runtime_error(options.name() + ": is " + foreign);
  }
  // What is none of these is refused with what was expected of the most usual one.
  return kRtabmapKind.open(options);
}

}  // namespace zonepack::packer
