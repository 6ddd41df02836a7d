// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/notify.hpp"
#include "platform/shared_memory.hpp"
#include "runtime/memory/arena_memory.hpp"
#include "runtime/memory/shared_map.hpp"
#include "runtime/settings/serve_settings.hpp"

namespace zonepack {

// The memory of a live run's zones: shared with the readers of a socket, or the run's alone.
class LiveMemory {
 public:
  struct Choice {
    std::uint32_t zones = 0, slots = 0;  // to have room for
    std::string socket;                  // empty: nobody is served
    bool must_serve = true;  // false: goes on without where the socket's folder is taken
    const Notifier* manager = nullptr;
    std::vector<HandedFile>* handed = nullptr;
  };

  // Never null.
  static Outcome<std::unique_ptr<LiveMemory>> open(const Choice& choice);

  // Why the run goes on unserved: a complete message, or empty.
  const std::string& warning() const noexcept { return warning_; }

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
  std::string warning_;
};

// Where zoned is to be reached: $ZONED_SOCKET, else as the settings say.
std::string socket_path(const ServeSettings& settings);

}  // namespace zonepack
