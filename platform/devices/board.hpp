// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/byte_count.hpp"

namespace zonepack {

// What a program needs of the computer it runs on.
struct BoardNeeds {
  int priority = 0;             // SCHED_FIFO
  std::optional<unsigned> cpu;  // the processor reserved for the control thread
  ByteCount locked_bytes = 0;
};

// One thing about the computer that steady timing or the memory limit depends on.
struct BoardFact {
  std::string name;
  std::string found;
  bool good = true;
  std::string mend;  // when not good: the exact command or line that fixes it
};

// The kernel, PREEMPT_RT, frequency governor, idle states, real-time throttling, isolated
// processors, interrupts, limits of locked memory and priority, memory compaction, page size, and
// the memory limit of the cgroup. A fact that the kernel does not report counts as good, and says
// so. `root`: the folder that holds /proc and /sys ("" on a robot). Allocates; reads files.
std::vector<BoardFact> inspect_board(const BoardNeeds& needs, const std::string& root = "");

// The memory that this computer has, or the limit of the cgroup where that is lower.
ByteCount machine_memory_bytes(const std::string& root = "");

}  // namespace zonepack
