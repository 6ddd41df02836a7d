// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/settings/settings.hpp"
#include "runtime/settings/yaml_section.hpp"

namespace zonepack {

// Reads can.canopen: the objects in the nodes' process data become signals NODE.INDEX in
// can.signals; what is watched goes into can.canopen.
//
// Source: CiA 301 (objects 0x1A00 on: index, sub-index and length of each mapped object, in order,
// little-endian without gaps); CiA 402, "Device profile for drives", for the types of its objects.
void read_canopen(YamlSection& can_section, CanSettings& can, FaultList& faults);

}  // namespace zonepack
