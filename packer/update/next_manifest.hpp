// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "packer/build/manifest_writer.hpp"
#include "packer/update/zone_packing.hpp"

// What the manifest of the next version says.
namespace zonepack::packer {

// All of it but what the version changed. `database` and `newcomers` are null when nothing was
// taken from a database. Counts go to `summary`. `plan` and `zones` outlive the result.
ManifestContent next_content(const fb::Manifest& before, const HeldSignatures& held,
                             const ZoneContents& contents, const ZonePlan& plan,
                             const PackedZones& zones, const MapSource* database,
                             const Newcomers* newcomers, UpdateSummary& summary);

// The entry of this update in the history of versions.
VersionChange change_since(const MapReader& before, const HeldSignatures& held,
                           const ZoneContents& contents, const UpdateOptions& options,
                           const UpdateSummary& summary);

}  // namespace zonepack::packer
