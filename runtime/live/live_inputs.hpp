// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "platform/base/failure.hpp"
#include "runtime/live/bus/can_capture.hpp"
#include "runtime/live/bus/live_source.hpp"

namespace zonepack {

// Where a live run takes frames, corrections and time from, and the copy of its frames that
// --record-can asks for.
//
// Threads: source().clock(), source().corrections() and bus() belong to the control thread, write()
// to the log thread, the rest to the owner.
class LiveInputs {
 public:
  // record_can: a file; empty: none.
  Outcome<void> open(LiveSourceTerms terms, const std::string& record_can);

  // After open().
  LiveSource& source() noexcept { return *source_; }
  const LiveSource& source() const noexcept { return *source_; }
  CanBus& bus() noexcept { return capture_ ? *capture_ : source_->bus(); }

  bool captures() const noexcept { return capture_ != nullptr; }
  void write() { capture_->write(); }

  void stop() noexcept {
    if (source_) source_->stop();
  }
  // Fails when a frame could not be written.
  Outcome<void> close();

 private:
  std::unique_ptr<LiveSource> source_;
  std::string capture_path_;
  std::unique_ptr<CanCapture> capture_;
};

}  // namespace zonepack
