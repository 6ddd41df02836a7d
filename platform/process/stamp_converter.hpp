// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zonepack {

// Converts the kernel's CLOCK_REALTIME stamps of items that waited in a queue to CLOCK_MONOTONIC.
//
// The wall clock may be set between the arrival of an item and its reading. The item arrived after
// the queue was last found empty and not later than now, which decides which of the two offsets its
// stamp was made with; where both fit, the stamp is off by less than that interval. Nothing else
// disturbs it.
//
// Real-time: a few additions.
class StampConverter {
 public:
  // offset_ns: CLOCK_REALTIME minus CLOCK_MONOTONIC before anything can wait in the queue.
  explicit StampConverter(std::int64_t offset_ns) noexcept : offset_ns_(offset_ns) {}

  // Starts with another queue: nothing in it arrived before after_ns.
  void restart(std::int64_t after_ns) noexcept;

  // To be called before converting the stamps of a reading: when it began and ended by
  // CLOCK_MONOTONIC, and the offset at its end.
  void read_between(std::int64_t began_ns, std::int64_t ended_ns, std::int64_t offset_ns) noexcept;

  std::int64_t monotonic_of(std::int64_t realtime_ns) const noexcept;

  // Reports that the last reading left nothing in the queue.
  void emptied() noexcept;

 private:
  std::int64_t after_ns_ = 0;
  std::int64_t began_ns_ = 0;
  std::int64_t ended_ns_ = 0;
  std::int64_t offset_ns_;
  std::int64_t older_offset_ns_ = offset_ns_;  // when the queue was last empty
};

// Maps the stamps of a controller's own clock, which starts at any value and drifts, to
// CLOCK_MONOTONIC. The software stamp of a frame follows its hardware stamp by a delay that is
// short at least now and then, so the smallest difference of the last one to two seconds serves as
// the distance of the clocks (error at a drift of 100 ppm: 0.2 ms). When the distance changes by
// more than 20 ms, the longest plausible delay, the clock was set and the new distance holds at
// once.
class HardwareStamps {
 public:
  // The hardware stamp in monotonic time, never later than the software stamp.
  std::int64_t monotonic_of(std::int64_t hardware_ns, std::int64_t software_ns) noexcept;

 private:
  std::int64_t bucket_began_ns_ = 0;
  std::int64_t least_ns_ = INT64_MAX;         // distance, in this second
  std::int64_t least_before_ns_ = INT64_MAX;  // and in the one before
};

}  // namespace zonepack
