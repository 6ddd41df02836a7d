// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/odometry/pose_filter.hpp"
#include "runtime/protocol/protocol_generated.h"

namespace zonepack {

// The clocks at one instant.
struct ClockReading {
  std::int64_t monotonic_ns = 0;
  std::int64_t run_ns = 0;
  std::int64_t offset_ns =
      0;  // realtime, or the time of a log that is played, minus the run's clock
};

// A pose that another program gave, on the run's clock; nothing when it is not a valid pose: a
// number that is not finite, a variance that is not positive, correlations over 1. The filter takes
// the standard deviations; correlations are checked and not used.
std::optional<PoseCorrection> correction_of(const wire::GivePose& given,
                                            const ClockReading& now) noexcept;

}  // namespace zonepack
