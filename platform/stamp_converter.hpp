// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zonepack {

// Turns the kernel's CLOCK_REALTIME stamps of what waited in a queue into CLOCK_MONOTONIC.
//
// A wall clock may be set between an arrival and the reading of it. What was read arrived after the
// queue was last found empty and not after now, which tells by which of the two offsets a stamp was
// made; where both would do, the stamp is off by less than that time. Nothing else harms it.
// Real-time: a few additions.
class StampConverter {
 public:
  // The offset (CLOCK_REALTIME minus CLOCK_MONOTONIC) before anything can wait in the queue.
  explicit StampConverter(std::int64_t offset_ns) noexcept : offset_ns_(offset_ns) {}

  // Nothing that is converted from now on arrived before after_ns: another queue.
  void restart(std::int64_t after_ns) noexcept;

  // Before converting what a reading gave: when it began and ended by CLOCK_MONOTONIC, and the
  // offset at its end.
  void read_between(std::int64_t began_ns, std::int64_t ended_ns, std::int64_t offset_ns) noexcept;

  std::int64_t monotonic_of(std::int64_t realtime_ns) const noexcept;

  // The last reading left nothing in the queue.
  void emptied() noexcept;

 private:
  std::int64_t after_ns_ = 0;
  std::int64_t began_ns_ = 0;
  std::int64_t ended_ns_ = 0;
  std::int64_t offset_ns_;
  std::int64_t older_offset_ns_ = offset_ns_;  // when the queue was last empty
};

// Places the stamps of a controller's own clock, which starts anywhere and drifts, on
// CLOCK_MONOTONIC: the software stamp of a frame follows its hardware stamp by a delay that is
// short at least once in a while, so the smallest difference of the last one to two seconds is
// taken as the distance of the clocks (a drift of 100 ppm: 0.2 ms). A clock that was set is
// followed at once when the distance changes by more than 20 ms, the longest delay that is
// believed.
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
