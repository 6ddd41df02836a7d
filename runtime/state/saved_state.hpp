// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/odometry/pose.hpp"
#include "runtime/pack_format/file/checksum.hpp"

namespace zonepack {

// What a robot knows about itself when it starts again: where it was, on which map. A guess, not
// trust: it may have been carried.
//
// File: magic "\x89ZPS\r\n\x1A\n", u16 major 1, u16 minor 0, u32 size of the content, u64 XXH3 of
// the content. Content, little endian: u64 sequence, u64 runs, 16 bytes lineage, 32 bytes version,
// i64 time, f64 x, y, yaw, f64 xx, xy, x_yaw, yy, y_yaw, yaw_yaw, u8 trusted, u8 length and name of
// the zone. What follows is for later versions.
//
// Odometer counters are not part of it: odometry works on differences, and the covariance of the
// guess covers what the robot did meanwhile.
struct SavedState {
  std::uint64_t sequence = 0;  // counts the saves; the highest is the newest
  std::uint64_t runs = 0;      // counts the starts of zoned
  Digest16 map_lineage{};
  Digest32 map_version{};
  std::int64_t realtime_ns = 0;  // CLOCK_REALTIME when saved
  Pose2 T_map_base;
  Covariance2 covariance;
  bool trusted = false;
  std::string zone;  // its name, at most kMaxNameBytes; empty: none
};

std::vector<std::byte> write_state(const SavedState& state);

// kTruncated, kBadMagic, kBadVersion, kBadChecksum, kBadStructure; kBadValue for a pose that is not
// finite.
Result<SavedState> read_state(ByteSpan file);

inline constexpr std::size_t kMostStateBytes = 4096;

}  // namespace zonepack
