// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "platform/base/result.hpp"
#include "runtime/pack_format/limits.hpp"

namespace zonepack {

// Where a manifest breaks the rules of the format, and which rule: what an Error has no room for.
struct ManifestFault {
  enum class Part : std::uint8_t { kWhole, kZone, kPortal, kEdge };
  Part part = Part::kWhole;
  std::uint32_t entry = 0;         // of the zones, portals or edges, from 0
  std::string_view name = {};      // of the zone or portal, in the manifest's bytes; empty when it
                                   // has none, or one that is not fit to be printed
  const char* field = "";          // as manifest.fbs calls it
  const char* expected = "";       // where `excess` is empty
  std::optional<Excess> excess{};  // the limit that it is beyond
};

// What check_manifest() found wrong, for people: "zone 'kitchen' (entry 3): vertices of a zone:
// 4097, the format holds at most 4096". Says neither the file nor what to do.
std::string manifest_fault_text(const Error& error, const ManifestFault& fault);

}  // namespace zonepack
