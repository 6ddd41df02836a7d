// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/files/file_lock.hpp"
#include "platform/memory/shared_memory.hpp"
#include "platform/process/notify.hpp"
#include "platform/process/presence.hpp"

namespace zonepack {

// The memory that zoned shares. A crashed zoned and its successor never hold two such blocks at
// once: readers of the old one keep its pages charged for as long as they map them.
//
// The service manager keeps the memory while zoned is down, and the next zoned takes over the same
// pages. A lock keeps a second zoned away while one runs; no reader ever has it. Where no manager
// keeps the memory, or the size differs, the readers' presence decides: every reader receives a
// share of that together with the memory, and zoned waits until the last one is gone.
class ArenaMemory {
 public:
  struct Source {
    std::string lock_path;  // in the folder of the socket
    std::chrono::milliseconds wait{5000};
    const Notifier* manager = nullptr;
    std::vector<HandedFile>* handed = nullptr;  // what the manager kept; taken out when used
  };

  // Where the presence of readers shows.
  static std::string readers_path(const Source& source) { return source.lock_path + ".readers"; }

  // kBusy: after `wait`, readers of an earlier zoned, or another zoned, still hold its memory.
  static Outcome<ArenaMemory> obtain(ByteCount bytes, const Source& source);

  // Why memory for zones was refused, whether it is shared or not.
  static Failure no_memory(const Error& error);

  std::span<std::byte> bytes() noexcept { return memory_.bytes(); }
  // True for the memory of an earlier zoned, with its content: SharedMap::lay_out() begins a new
  // epoch there.
  bool taken_over() const noexcept { return taken_over_; }

  // For each reader: the memory, open for reading only, and a share of the readers' presence, to be
  // sent along. A reader can only keep or close it.
  Result<Descriptor> reader_memory() const { return memory_.reader_file(); }
  Result<Descriptor> reader_presence() const { return readers_.share(); }

 private:
  ArenaMemory(SharedMemory memory, FileLock lock, Presence readers, bool taken_over)
      : memory_(std::move(memory)),
        lock_(std::move(lock)),
        readers_(std::move(readers)),
        taken_over_(taken_over) {}

  SharedMemory memory_;
  FileLock lock_;
  Presence readers_;
  bool taken_over_;
};

}  // namespace zonepack
