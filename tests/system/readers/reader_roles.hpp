// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "runtime/client/shared_reader.hpp"
#include "tests/system/readers/zone_images.hpp"

namespace zonepack::test_support {

inline constexpr std::uint32_t kZones = 24;

enum class Role : std::uint8_t {
  kOrdinary,
  kHangs,      // stops in the middle of a read until the zone has been reloaded, then reads on
  kOverstays,  // reads the same zone again and again long after it was unloaded
  kKilled      // is killed while it reads
};
const char* to_string(Role role);

// What writer and readers exchange, in separate memory that all may write.
struct ReaderCounts {
  std::atomic<std::uint64_t> ok, expired, absent, damaged;
  std::atomic<std::uint64_t> torn_refused;   // mixed values, and read() reported it
  std::atomic<std::uint64_t> torn_accepted;  // mixed values, and read() reported them as good
  std::atomic<std::uint64_t> outlived;       // reads during which the zone was reloaded
};
struct Blackboard {
  std::atomic<bool> done;
  std::array<std::atomic<std::uint32_t>, kZones> loads;  // of each zone
  std::array<ReaderCounts, 8> readers;
};

// Reads zones at random until board.done.
void run_reader(Role role, std::uint32_t seed, SharedReader& reader, const ZoneImages& images,
                const Blackboard& board, ReaderCounts& counts);

}  // namespace zonepack::test_support
