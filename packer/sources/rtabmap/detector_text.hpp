// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "packer/record/map_outline.hpp"

namespace zonepack::packer {

// What a manifest says of the detector that found the map's features, so that a camera's images can
// be treated alike: RTAB-Map's number and, after a blank, the settings that the source stored for
// it ("8 Kp/MaxFeatures:400;GFTT/BlockSize:3;ORB/NLevels:3"). Only the number where it stored none,
// nothing where it names no detector.
std::string detector_text(const MapOutline& outline);

}  // namespace zonepack::packer
