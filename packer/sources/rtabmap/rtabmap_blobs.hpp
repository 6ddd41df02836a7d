// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "packer/record/damage.hpp"
#include "packer/record/record.hpp"
#include "packer/sources/rtabmap/rtabmap_schema.hpp"

// The layouts of RTAB-Map's blobs, checked before they are packed.
namespace zonepack::packer {

// float32 channels of a scan format, 1 (XY) to 12 (XYZIRT); 0 for any other number.
std::uint32_t scan_channels(std::int32_t format) noexcept;

// Fills all of `scan` except its data. Since 0.18: 19 float32 {format, range min, range max,
// angle min, angle max, increment, max points, local 12}. Databases of earlier versions may also
// have 15 (from 0.16.1) {max points, range max, format, local 12} or 14 {max points, range max,
// local 12}. An empty blob leaves format 0.
void parse_scan_info(std::span<const std::byte> info, SchemaVersion version, const CellPlace& place,
                     Scan& scan);

// Checks a scan's points: float32, with the channels of its format; 1 to 10 for an unknown format.
void check_scan(const Scan& scan, const CellPlace& place);

// Checks the cells of a local grid: float32 with 2 (2D), 3, 4 or 6 (3D) channels.
void check_grid_cells(const Matrix& cells, const CellPlace& place);

// Checks camera calibrations. Since 0.18: a sequence of records of mono or stereo cameras, each
// starting with its sizes. Databases of earlier versions may also have 18 float32 per camera (16
// before 0.11.2), or 19 or 17 for one stereo camera.
void check_calibration(std::span<const std::byte> bytes, SchemaVersion version,
                       const CellPlace& place);

}  // namespace zonepack::packer
