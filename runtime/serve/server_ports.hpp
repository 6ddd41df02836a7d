// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "platform/base/result.hpp"
#include "platform/files/bounded_writer.hpp"
#include "platform/memory/seqlock.hpp"
#include "platform/memory/spsc_queue.hpp"
#include "runtime/control/command.hpp"
#include "runtime/control/event.hpp"
#include "runtime/odometry/pose_filter.hpp"
#include "runtime/run/figures/line_board.hpp"
#include "runtime/run/figures/live_status.hpp"
#include "runtime/serve/zone_table.hpp"

namespace zonepack {

// What connects the server to the run: values that the control thread publishes, and queues that
// may be full, so that neither waits for the other. All of it outlives the server, which is the
// only one to pop `events` and `replies` and to push to `commands` and `poses`.
struct ServerPorts {
  const Seqlock<LiveStatus>& status;
  SpscQueue<Event>& events;
  SpscQueue<Command>& commands;
  SpscQueue<CommandReply>& replies;
  SpscQueue<PoseCorrection>& poses;

  // What clients may map and hold, sent with the welcome; -1: there is none.
  int memory_fd = -1;    // open for reading only
  int presence_fd = -1;  // shows that a reader of the memory is left; releases nothing

  std::uint32_t map_epoch = 0;  // of the memory, with the first map; incremented at every change

  std::int64_t lease_ns = 0;  // as Residency ends leases

  // Called when events were lost: what can be read now. Any thread.
  ResidentGeneration resident_generation{};

  // Writes the recording of the last minutes and returns its bytes. Takes as long as the writer
  // allows; called in a thread of its own. Empty: there is no recording.
  std::function<Result<std::uint64_t>(BoundedWriter& to)> dump{};

  // Of the program, for those who ask which one runs.
  std::string release = "unknown", commit = "unknown";

  const LineBoard* lines = nullptr;  // of the robot; null: none
};

}  // namespace zonepack
