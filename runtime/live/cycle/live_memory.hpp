// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/memory/shared_memory.hpp"
#include "platform/process/notify.hpp"
#include "runtime/memory/arena_memory.hpp"
#include "runtime/memory/shared_map.hpp"

namespace zonepack {

// The memory of a live run's zones: shared with the readers of a socket, or the run's alone.
class LiveMemory {
 public:
  struct Choice {
    std::uint32_t zones = 0, slots = 0;  // to have room for
    std::string socket;                  // empty: nobody is served
    bool may_wait = true;                // for an earlier zoned that is ending, and its readers
    const Notifier* manager = nullptr;
    std::vector<HandedFile>* handed = nullptr;
  };

  // Never null. Fails when somebody is to be served, and the memory cannot be shared.
  static Outcome<std::unique_ptr<LiveMemory>> open(const Choice& choice);

  SharedMap& map() noexcept { return *map_; }
  bool served() const noexcept { return arena_.has_value(); }
  // For readers; -1 when not served.
  int reader_fd() const noexcept { return reader_.get(); }
  int presence_fd() const noexcept { return presence_.get(); }

 private:
  LiveMemory() = default;
  Outcome<void> share(const Choice& choice);

  std::optional<ArenaMemory> arena_;
  std::optional<SharedMemory> own_;
  std::optional<SharedMap> map_;
  Descriptor reader_, presence_;
};

}  // namespace zonepack
