// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "platform/base/result.hpp"
#include "platform/can/can_bus.hpp"
#include "platform/memory/spsc_queue.hpp"

namespace zonepack {

// A bus that keeps what is received from it: the frames that passed the settings' filters and error
// frames, as `candump -l` writes them, with a DROPCOUNT line where some were lost, to a file that
// zoned, canplayer and log2asc read.
//
// Stamps are on the wall clock as it stood at the start: one that is set later does not tear the
// recording apart.
//
// Real-time: receive() adds a copy for each frame; where the writer does not keep up, the recording
// loses frames, the run none.
// Threads: receive(), dropped() and status() by the control thread; the rest by one other.
class CanCapture final : public CanBus {
 public:
  // clock_offset_ns: wall clock minus the clock of the frames' stamps.
  CanCapture(CanBus& bus, std::string interface, std::int64_t clock_offset_ns);

  // kIo with errno: cannot be written. An existing file is replaced.
  Result<void> open(const std::string& path);
  // Writes what has come since the last call.
  void write();
  // The first error of any write, or none.
  Result<void> close();

  std::size_t receive(std::span<CanFrame> into) noexcept override;
  std::uint64_t dropped() const noexcept override { return bus_.dropped(); }
  CanBusStatus status() const noexcept override { return bus_.status(); }

 private:
  struct Item {
    CanFrame frame;
    std::uint64_t lost_before = 0;  // since the start
  };
  struct Closer {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };

  void put(std::string_view text);
  void note_losses(std::uint64_t lost);

  CanBus& bus_;
  std::string interface_;
  std::int64_t clock_offset_ns_;
  SpscQueue<Item> items_;
  std::uint64_t not_kept_ = 0;  // the queue was full
  std::unique_ptr<std::FILE, Closer> file_;
  std::string line_;
  std::uint64_t lost_told_ = 0;
  std::int64_t flushed_ns_ = 0;
  int error_ = 0;
};

}  // namespace zonepack
