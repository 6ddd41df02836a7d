// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "platform/base/byte_count.hpp"

namespace zonepack {

// The result of a replay in numbers; `zoned replay --json` prints these names.
struct PoseError {
  double p50 = 0, p95 = 0, max = 0;  // metres, distance to the true position
};

struct RunSummary {
  ByteCount budget_bytes = 0;
  ByteCount peak_charged_bytes = 0;
  std::uint64_t budget_violations = 0;  // cycles over either limit
  std::uint64_t max_signatures = 0;     // 0: no such limit
  std::uint64_t peak_signatures = 0;
  std::uint64_t signatures_loaded = 0;
  std::uint64_t signatures_unloaded = 0;
  std::uint64_t zones_loaded = 0;
  std::uint64_t zones_unloaded = 0;
  ByteCount bytes_loaded = 0;
  std::uint64_t zone_switches = 0;
  double start_s = 0;        // until the first zone is resident
  double zone_absent_s = 0;  // after that: time without the robot's own zone, by truth where given
  double blocked_s = 0;
  double wrong_zone_s = 0;  // truth more than 0.3 m inside another zone than the tracker's
  std::optional<PoseError> pose_error_m;  // nothing without truth
  std::uint64_t cycles = 0;
  std::uint64_t can_frames = 0;
  std::uint64_t can_rejected = 0;
  std::uint64_t corrections_used = 0;
  std::uint64_t corrections_rejected = 0;
  std::string event_log_hash;  // BLAKE2b-256 of the event log, hex
};

}  // namespace zonepack
