// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "packer/record/record.hpp"

// What a signature shows of the space around it, whatever kind of map it comes from.
namespace zonepack::packer {

enum class Seen : std::uint8_t { kSurface, kFree };

// A place in the map frame, metres.
using SeenPlace = std::function<void(double x_m, double y_m, double z_m, Seen seen)>;

// The payloads that show places.
inline constexpr PayloadSet kPlacesOnly{.features = false,
                                        .scan = true,
                                        .grid = false,
                                        .image = false,
                                        .depth = false,
                                        .userdata = false,
                                        .blocks = true};

// The points of a scan with heights are surfaces; scans in one plane show nothing here. A voxel
// shows the place of its center: in the TSDF a surface where it was observed behind one or up to
// 0.75 voxels in front, else free space; without a TSDF the occupancy decides (log odds), without
// that the ESDF. Voxels that were not observed show nothing. Places that are no numbers or over
// 10,000 km away are left out. Throws std::runtime_error where the layers of blocks are not whole.
void for_each_place(const SignatureRecord& record, const SeenPlace& place);

// The side of a cell for what the signature shows: 0.05 m or, of voxels, the least multiple of
// theirs that is no smaller. 0: it shows nothing.
double cell_size_of(const SignatureRecord& record);

}  // namespace zonepack::packer
