// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "packer/sources/damage.hpp"

// Images are carried as stored, never decoded; these look at their frame only: the kind of file,
// and that it is whole. Empty bytes pass.
namespace zonepack::packer {

// JPEG or PNG.
void check_image(std::span<const std::byte> bytes, const Place& place);

// Depth, or the right image of a stereo camera: PNG (16-bit millimetres, or the four bytes of a
// float32), JPEG, RVL ("DEPTHRVL"), or inverse depth ("DEPTHINV") around a PNG or RVL.
void check_depth(std::span<const std::byte> bytes, const Place& place);

}  // namespace zonepack::packer
