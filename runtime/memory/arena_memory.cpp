// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/arena_memory.hpp"

#include <algorithm>
#include <cerrno>

#include "platform/files/file_kind.hpp"

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

Failure why_busy(const ArenaMemory::Source& source) {
  return failure(
      "the memory of an earlier zoned is still held by programs that read it, or by a zoned that "
      "runs: end them (fuser " +
          source.lock_path + " " + ArenaMemory::readers_path(source) +
          " lists their process ids; package psmisc), or run zoned as a service that keeps its "
          "memory (FileDescriptorStoreMax=2)",
      ErrorCode::kBusy);
}

// The file at `path` could not be had.
Failure refused(const std::string& path, const char* expected, const Error& error) {
  const auto other = not_a_regular_file(path);
  if (error.code == ErrorCode::kExists) {
    return failure("serve.socket: " + path + ": is " + other.value_or("a regular file") +
                       "; expected " + expected + " of zoned's own, or nothing; remove it",
                   error.code);
  }
  return failure("serve.socket: " + path + ": " + reason_text(error) +
                     "; its folder must exist and be writable for this user",
                 error.code);
}

Failure unkept(const Error& error) {
  return failure("the service manager does not keep the shared memory: " + reason_text(error) +
                     "; run zoned without NOTIFY_SOCKET",
                 error.code);
}

}  // namespace

Outcome<ArenaMemory> ArenaMemory::obtain(ByteCount bytes, const Source& source) {
  const std::string readers_at = readers_path(source);
  Descriptor kept_memory = take(source.handed, kMemoryName);
  Descriptor kept_lock = take(source.handed, kLockName);
  if (kept_memory.is_open() && kept_lock.is_open()) {
    Result<FileLock> lock = FileLock::adopt(std::move(kept_lock));
    if (lock) {
      Result<SharedMemory> memory = SharedMemory::adopt(std::move(kept_memory), bytes);
      Result<Presence> readers = Presence::join(readers_at);
      if (!readers) return refused(readers_at, "a FIFO", readers.error());
      if (memory) {
        return ArenaMemory(std::move(*memory), std::move(*lock), std::move(*readers), true);
      }
    }
  }
  // Unusable: release it before waiting for anything.
  kept_memory = Descriptor();
  kept_lock = Descriptor();
  const Notifier none;
  const Notifier& manager = source.manager == nullptr ? none : *source.manager;
  for (const char* const name : {kMemoryName, kLockName}) {
    if (const Result<void> forgotten = manager.forget(name); !forgotten) {
      return unkept(forgotten.error());
    }
  }
  Result<FileLock> lock = FileLock::acquire(source.lock_path, source.wait);
  if (!lock && lock.error().code == ErrorCode::kBusy) return why_busy(source);
  if (!lock) return refused(source.lock_path, "a file", lock.error());
  Result<Presence> readers = Presence::begin(readers_at, source.wait);
  if (!readers && readers.error().code == ErrorCode::kBusy) return why_busy(source);
  if (!readers) return refused(readers_at, "a FIFO", readers.error());
  Result<SharedMemory> memory = SharedMemory::create(kMemoryName, bytes);
  if (!memory) return no_memory(memory.error());
  Result<void> kept = manager.keep(kMemoryName, memory->file());
  if (kept) kept = manager.keep(kLockName, lock->file());
  if (!kept) return unkept(kept.error());
  return ArenaMemory(std::move(*memory), std::move(*lock), std::move(*readers), false);
}

Failure ArenaMemory::no_memory(const Error& error) {
  const bool limited = error.code == ErrorCode::kIo && error.detail == EFBIG;
  return failure("memory.budget: the memory cannot be had: " + reason_text(error) +
                     (limited ? "; the limit on the size of files (ulimit -f) counts for it too: "
                                "raise that"
                              : "; allow less, or end other programs"),
                 error.code);
}

}  // namespace zonepack
