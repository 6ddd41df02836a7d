// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/arena_memory.hpp"

#include <algorithm>

namespace zonepack {
namespace {

constexpr const char* kMemoryName = "zonepack-arena";
constexpr const char* kLockName = "zonepack-arena-lock";

Descriptor take(std::vector<HandedFile>* handed, const char* name) {
  if (handed == nullptr) return {};
  const auto found = std::ranges::find(*handed, name, &HandedFile::name);
  if (found == handed->end()) return {};
  Descriptor file = std::move(found->file);
  handed->erase(found);
  return file;
}

}  // namespace

Result<ArenaMemory> ArenaMemory::obtain(ByteCount bytes, const Source& source) {
  Descriptor kept_memory = take(source.handed, kMemoryName);
  Descriptor kept_lock = take(source.handed, kLockName);
  if (kept_memory.is_open() && kept_lock.is_open()) {
    Result<FileLock> lock = FileLock::adopt(std::move(kept_lock));
    if (lock) {
      Result<SharedMemory> memory = SharedMemory::adopt(std::move(kept_memory), bytes);
      if (memory) return ArenaMemory(std::move(*memory), std::move(*lock), true);
    }
  }
  // Unusable: release it before waiting for anything.
  kept_memory = Descriptor();
  kept_lock = Descriptor();
  const Notifier none;
  const Notifier& manager = source.manager == nullptr ? none : *source.manager;
  for (const char* const name : {kMemoryName, kLockName}) {
    if (const Result<void> forgotten = manager.forget(name); !forgotten) return forgotten.error();
  }
  Result<FileLock> lock = FileLock::acquire(source.lock_path, source.wait);
  if (!lock) return lock.error();
  Result<SharedMemory> memory = SharedMemory::create(kMemoryName, bytes);
  if (!memory) return memory.error();
  Result<void> kept = manager.keep(kMemoryName, memory->file());
  if (kept) kept = manager.keep(kLockName, lock->file());
  if (!kept) return kept.error();
  return ArenaMemory(std::move(*memory), std::move(*lock), false);
}

std::string ArenaMemory::why_busy(const Source& source) {
  return "the memory of an earlier zoned is still held by programs that read it, or by a zoned "
         "that runs: end them (fuser " +
         source.lock_path +
         " names them), or run zoned as a service that keeps its memory (FileDescriptorStoreMax=2)";
}

}  // namespace zonepack
