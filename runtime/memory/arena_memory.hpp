// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "platform/file_lock.hpp"
#include "platform/notify.hpp"
#include "platform/shared_memory.hpp"

namespace zonepack {

// The memory that zoned shares. A crashed zoned and its successor never hold two such blocks at
// once: readers of the old one keep its pages charged for as long as they map them.
//
// The service manager keeps the memory while zoned is down, and the next zoned takes over the same
// pages. Where no manager does, or the size differs, a lock decides: every reader receives a share
// of it together with the memory, so it stays held until the last reader is gone.
class ArenaMemory {
 public:
  struct Source {
    std::string lock_path;  // in the folder of the socket
    std::chrono::milliseconds wait{5000};
    const Notifier* manager = nullptr;
    std::vector<HandedFile>* handed = nullptr;  // what the manager kept; taken out when used
  };

  // kBusy: after `wait`, readers of an earlier zoned, or another zoned, still hold its memory;
  // why_busy() explains it to people. kIo with errno.
  static Result<ArenaMemory> obtain(ByteCount bytes, const Source& source);
  static std::string why_busy(const Source& source);

  std::span<std::byte> bytes() noexcept { return memory_.bytes(); }
  // True for the memory of an earlier zoned, with its content: SharedMap::lay_out() begins a new
  // epoch there.
  bool taken_over() const noexcept { return taken_over_; }

  // For each reader: the memory, open for reading only, and a share of the lock, to be sent along.
  Result<Descriptor> reader_memory() const { return memory_.reader_file(); }
  Result<Descriptor> reader_lock() const { return lock_.file().share(); }

 private:
  ArenaMemory(SharedMemory memory, FileLock lock, bool taken_over)
      : memory_(std::move(memory)), lock_(std::move(lock)), taken_over_(taken_over) {}

  SharedMemory memory_;
  FileLock lock_;
  bool taken_over_;
};

}  // namespace zonepack
