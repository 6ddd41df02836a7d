// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "platform/base/failure.hpp"
#include "platform/can/can_frame_source.hpp"
#include "platform/can/can_log.hpp"
#include "runtime/live/bus/can_source.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {

// Where `zoned listen` takes its frames from. A log without a speed gives them as fast as they are
// read; everything else gives them when they are due.
struct FeedChoice {
  CanSourceChoice source;
  bool paced = true;
};

// As `zoned run` names its sources, or the plain name of a log; nothing for other texts.
std::optional<FeedChoice> parse_feed_choice(const std::string& text);

// Frames of a bus or a log. Nothing is ever sent.
//
// Threads: one.
class FrameFeed : public CanFrameSource {
 public:
  static Outcome<std::unique_ptr<FrameFeed>> open(const FeedChoice& choice,
                                                  const Settings& settings);

  // The next frame that is due; nothing while none is.
  std::optional<CanFrame> next() noexcept override = 0;
  virtual bool ended() const noexcept = 0;           // none will come any more
  virtual std::int64_t now_ns() const noexcept = 0;  // on the clock of the stamps
  virtual bool paced() const noexcept = 0;
  // What has changed at the bus since the last call.
  virtual std::optional<std::string> message() { return std::nullopt; }
  virtual const CanLogSummary* log_summary() const noexcept { return nullptr; }
};

}  // namespace zonepack
