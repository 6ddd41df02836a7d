// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "packer/build/manifest_writer.hpp"

// What a manifest says, as the packer's own structures.
namespace zonepack::packer {

ZonePlan plan_of(const fb::Manifest& manifest);
PackSummary pack_of(const fb::Zone& zone);
std::vector<NamedLayer> layers_of(const fb::Manifest& manifest);
std::vector<VersionChange> changes_of(const fb::Manifest& manifest);

}  // namespace zonepack::packer
