// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "platform/base/byte_count.hpp"
#include "platform/descriptor.hpp"

namespace zonepack {

// One block of memory that its writer hands to readers as an open file. Its size is sealed: nobody
// can make a page vanish under another. It lives as long as somebody has it open or mapped, and is
// charged to whoever touched a page first.
//
// Readers get a file that is open for reading only, and the memory's mode is 0400: mapping it
// writable, or opening it anew to write, fails for every process of another user that is not root.
// (F_SEAL_FUTURE_WRITE would say so once and for all, but would also keep a writer that was
// restarted from taking its memory over.)
//
// Errors: kIo with errno; kMismatch when a file is not such memory, or of another size.
class SharedMemory {
 public:
  // New, zeroed, every page present. `name` is what /proc/PID/maps shows.
  static Result<SharedMemory> create(const char* name, ByteCount bytes);

  // For a writer that was restarted: memory that create() made earlier, its content untouched.
  static Result<SharedMemory> adopt(Descriptor file, ByteCount bytes);

  // For a reader: what reader_file() gave.
  static Result<SharedMemory> map_read_only(Descriptor file);

  SharedMemory(SharedMemory&& other) noexcept;
  SharedMemory& operator=(SharedMemory&& other) noexcept;
  ~SharedMemory();

  // The writer's.
  std::span<std::byte> bytes() noexcept;
  // Anyone's.
  std::span<const std::byte> read_only() const noexcept { return {begin_, size_}; }

  const Descriptor& file() const noexcept { return file_; }

  // The memory, open for reading only, to be sent to a reader.
  Result<Descriptor> reader_file() const;

 private:
  SharedMemory(Descriptor file, std::byte* begin, std::size_t size, bool writable) noexcept
      : file_(std::move(file)), begin_(begin), size_(size), writable_(writable) {}
  static Result<SharedMemory> map_writable(Descriptor file, ByteCount bytes);

  Descriptor file_;
  std::byte* begin_ = nullptr;
  std::size_t size_ = 0;
  bool writable_ = false;
};

}  // namespace zonepack
