// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/run/inputs/run_files.hpp"

// The time of a CAN log whose clock was set on the way. CanLogReader gives frames on the clock of
// the first one; poses that were written beside the log have the stamps of the log as it stands.
namespace zonepack {

class LogTime {
 public:
  static constexpr std::size_t kMostStretches = 1024;

  // Reads the log to its end. Without a step of its clock, and for a file that can be read only
  // once (a pipe), an identity. Once kMostStretches are known, the last one takes in the rest.
  static LogTime read(const std::string& path, const std::string& interface);

  bool steps() const noexcept { return stretches_.size() > 1; }

  // A stamp of the log's own clock, on the clock of the first frame: by the stretch whose stamps it
  // is among or next to; by the first of those where several have it.
  std::int64_t on_first_clock(std::int64_t stamp_ns) const noexcept;

  // The same for files that go with the log. Corrections are in the order in which they were
  // written, which decides where a clock that was set back gave the same stamps twice; they are
  // returned in order of reception.
  std::vector<PoseCorrection> on_first_clock(std::vector<PoseCorrection> as_written) const;
  TruthTrack on_first_clock(const TruthTrack& truth) const;

 private:
  struct Stretch {                           // between two steps
    std::int64_t first_ns = 0, last_ns = 0;  // least and largest stamp, as the log has them
    std::int64_t added_ns = 0;
  };
  // Index of the stretch that is nearest, from `first` on; the least of several.
  std::size_t stretch_of(std::int64_t stamp_ns, std::size_t first) const noexcept;

  std::vector<Stretch> stretches_;
};

}  // namespace zonepack
