// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "packer/record/damage.hpp"

// Images are packed as stored and never decoded, so only their kind is checked: a picture that a
// camera delivered without its last bytes is still a picture, left to its decoder. Empty bytes
// pass.
namespace zonepack::packer {

// JPEG or PNG.
void check_image(std::span<const std::byte> bytes, const CellPlace& place);

// Depth, or the right image of a stereo camera: PNG (16-bit millimetres, or the four bytes of a
// float32), JPEG, RVL ("DEPTHRVL", columns, rows, stream), or inverse depth ("DEPTHINV" and two
// float32) around a PNG or RVL.
void check_depth(std::span<const std::byte> bytes, const CellPlace& place);

}  // namespace zonepack::packer
