// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "platform/base/byte_count.hpp"
#include "platform/files/descriptor.hpp"

namespace zonepack {

// One block of memory that its writer passes to readers as an open file. Its size is sealed: no
// process can make a page vanish under another. It lives as long as any process has it open or
// mapped, and each page is charged to the process that touched it first.
//
// Readers get a file that is open for reading only, and the memory's mode is 0400: mapping it
// writable, or reopening it for writing, fails for every process of another user that is not root.
// (F_SEAL_FUTURE_WRITE would rule this out altogether, but would also keep a restarted writer from
// taking over its memory.)
//
// Errors: kIo with errno; kMismatch when a file is not such memory, or of another size.
class SharedMemory {
 public:
  // New memory, zeroed, every page present. /proc/PID/maps shows `name`.
  static Result<SharedMemory> create(const char* name, ByteCount bytes);

  // For a restarted writer: memory that an earlier create() made, its content untouched.
  static Result<SharedMemory> adopt(Descriptor file, ByteCount bytes);

  // For a reader: a file from reader_file().
  static Result<SharedMemory> map_read_only(Descriptor file);

  SharedMemory(SharedMemory&& other) noexcept;
  SharedMemory& operator=(SharedMemory&& other) noexcept;
  ~SharedMemory();

  // For the writer.
  std::span<std::byte> bytes() noexcept;
  // For the writer and readers.
  std::span<const std::byte> read_only() const noexcept { return {begin_, size_}; }

  const Descriptor& file() const noexcept { return file_; }

  // The memory opened for reading only, to send to a reader.
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
