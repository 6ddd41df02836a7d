// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/cycle/live_memory.hpp"

#include <filesystem>

#include "platform/base/failure.hpp"

namespace zonepack {

Outcome<void> LiveMemory::share(const Choice& choice) {
  const std::filesystem::path folder = std::filesystem::path(choice.socket).parent_path();
  std::error_code ignored;
  std::filesystem::create_directory(folder, ignored);
  ArenaMemory::Source source{(folder / "zoned.lock").string()};
  if (!choice.may_wait) source.wait = std::chrono::milliseconds(0);
  source.manager = choice.manager;
  source.handed = choice.handed;
  auto arena = ArenaMemory::obtain(shared_map_bytes(choice.zones, choice.slots), source);
  if (!arena) return arena.error();
  auto reader = arena->reader_memory();
  auto presence = arena->reader_presence();
  if (!reader || !presence) {
    const Error& error = reader ? presence.error() : reader.error();
    return failure("the memory cannot be opened for readers: " + reason_text(error) +
                       "; /proc must be mounted",
                   error.code);
  }
  arena_.emplace(std::move(*arena));
  reader_ = std::move(*reader);
  presence_ = std::move(*presence);
  return {};
}

Outcome<std::unique_ptr<LiveMemory>> LiveMemory::open(const Choice& choice) {
  std::unique_ptr<LiveMemory> made(new LiveMemory());
  if (!choice.socket.empty()) {
    if (const auto shared = made->share(choice); !shared) {
      return failure("socket " + choice.socket +
                         ": nobody can be served: " + shared.error().message +
                         "; --socket PATH (serve.socket) takes another place, --socket \"\" serves "
                         "nobody",
                     shared.error().code);
    }
  }
  if (!made->arena_) {
    auto own = SharedMemory::create("zoned-zones", shared_map_bytes(choice.zones, choice.slots));
    if (!own) return ArenaMemory::no_memory(own.error());
    made->own_.emplace(std::move(*own));
  }
  auto map = SharedMap::lay_out(made->arena_ ? made->arena_->bytes() : made->own_->bytes(),
                                choice.zones, choice.slots);
  if (!map) {
    return failure("the memory of an earlier zoned cannot be taken over: " +
                       reason_text(map.error()) + "; start zoned once more",
                   map.error().code);
  }
  made->map_.emplace(std::move(*map));
  return made;
}

}  // namespace zonepack
