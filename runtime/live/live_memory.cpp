// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/live_memory.hpp"

#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "platform/base/failure.hpp"

namespace zonepack {
std::string socket_path(const ServeSettings& settings) {
  const char* const given = std::getenv("ZONED_SOCKET");
  return given != nullptr ? given : settings.socket;
}

bool LiveMemory::share(const Choice& choice, std::string& fault) {
  const std::filesystem::path folder = std::filesystem::path(choice.socket).parent_path();
  std::error_code ignored;
  std::filesystem::create_directory(folder, ignored);
  ArenaMemory::Source source{(folder / "zoned.lock").string()};
  if (!choice.must_serve) source.wait = std::chrono::milliseconds(0);
  source.manager = choice.manager;
  source.handed = choice.handed;
  auto arena = ArenaMemory::obtain(shared_map_bytes(choice.zones, choice.slots), source);
  if (!arena) {
    fault = arena.error().code == ErrorCode::kBusy
                ? ArenaMemory::why_busy(source)
                : "serve.socket: " + source.lock_path + ": " + reason_text(arena.error()) +
                      "; its folder must exist and be writable";
    return false;
  }
  auto reader = arena->reader_memory();
  auto lock = arena->reader_lock();
  if (!reader || !lock) {
    fault = "the memory cannot be opened for readers: " +
            reason_text(reader ? lock.error() : reader.error()) + "; /proc must be mounted";
    return false;
  }
  arena_.emplace(std::move(*arena));
  reader_ = std::move(*reader);
  lock_ = std::move(*lock);
  return true;
}

std::unique_ptr<LiveMemory> LiveMemory::open(const Choice& choice, std::string& fault,
                                             std::string& warning) {
  std::unique_ptr<LiveMemory> made(new LiveMemory());
  if (!choice.socket.empty() && !made->share(choice, fault)) {
    if (choice.must_serve) return nullptr;
    warning = "nobody is served: " + fault;
  }
  if (!made->arena_) {
    auto own = SharedMemory::create("zoned-zones", shared_map_bytes(choice.zones, choice.slots));
    if (!own) {
      fault = "memory.budget: the memory cannot be had: " + reason_text(own.error()) +
              "; allow less, or end other programs";
      return nullptr;
    }
    made->own_.emplace(std::move(*own));
  }
  auto map = SharedMap::lay_out(made->arena_ ? made->arena_->bytes() : made->own_->bytes(),
                                choice.zones, choice.slots);
  if (!map) {
    fault = "the memory of an earlier zoned cannot be taken over: " + reason_text(map.error()) +
            "; start zoned once more";
    return nullptr;
  }
  made->map_.emplace(std::move(*map));
  return made;
}

}  // namespace zonepack
