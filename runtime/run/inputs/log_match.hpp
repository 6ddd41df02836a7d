// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/can/can_frame_source.hpp"
#include "platform/can/can_log.hpp"
#include "runtime/odometry/wheel_odometry.hpp"

namespace zonepack {

// Passes the frames of a log on and counts them by id, to say whether the settings fit the log.
//
// Memory: at most kMostIds ids; further ones are counted together.
class LogMatch final : public CanFrameSource {
 public:
  static constexpr std::size_t kMostIds = 1024;

  explicit LogMatch(CanFrameSource& frames) : frames_(frames) {}

  std::optional<CanFrame> next() noexcept override;
  std::uint64_t dropped() const noexcept override { return frames_.dropped(); }

  // Earliest and latest stamp; meaningful once a frame came.
  std::int64_t first_ns() const noexcept { return first_ns_; }
  std::int64_t last_ns() const noexcept { return last_ns_; }

  // What odometry looked for and never found, and what the log holds instead; empty when every id
  // came. `path` is the log's; `holder` is "log" or "bus".
  std::string mismatch(const WheelOdometrySettings& settings, const std::string& path,
                       const CanLogSummary& summary, const std::string& holder = "log") const;

 private:
  using Id = std::pair<std::uint32_t, bool>;  // id, 29 bits

  CanFrameSource& frames_;
  std::map<Id, std::uint64_t> counts_;
  std::uint64_t others_ = 0;  // frames of ids beyond kMostIds
  std::uint64_t frames_seen_ = 0;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
};

// "1718021600.001 to 1718021655.400 s".
std::string range_text(std::int64_t first_ns, std::int64_t last_ns);

// Fails when nothing of a file that covers [first, last] lies within the log's time; `what` names
// the file. Both ranges are in the message.
Outcome<void> check_overlap(const std::string& what, std::int64_t first_ns, std::int64_t last_ns,
                            const std::string& log, const LogMatch& match);
Outcome<void> check_overlap(const std::string& what, std::int64_t first_ns, std::int64_t last_ns,
                            const std::string& log, std::int64_t log_first_ns,
                            std::int64_t log_last_ns);

}  // namespace zonepack
