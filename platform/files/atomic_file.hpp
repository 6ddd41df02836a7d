// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "platform/base/result.hpp"

namespace zonepack {

// A file that appears whole or not at all: written next to its final name as NAME.part-PID-N, then
// fsync, rename, fsync of the folder. When the object is destroyed without commit() (an error, an
// exception), it removes the part and leaves the file under the final name untouched. A killed
// process leaves its part behind; is_part_name() recognises it. A symbolic link stays, and its
// target is replaced. Anything that is not a regular file (a device, a pipe) is written in place,
// as are /dev/stdout, /dev/stderr and /dev/fd/N, whatever they lead to.
//
// Errors: kIo with errno.
// Threads: one at a time per object; not for the control thread.
class AtomicFile {
 public:
  // Opens the part next to `path`, or the file to write in place; the folder must exist.
  // A FIFO is opened only if somebody reads it within a second (ENXIO).
  static Result<AtomicFile> create(std::string path);

  // The process's standard output, written in place.
  static Result<AtomicFile> standard_output();

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  // Appends without buffering, so pass large pieces.
  Result<void> write(std::span<const std::byte> bytes) noexcept;
  Result<void> write(std::string_view text) noexcept;

  // Makes the file durable under the name given to create(). Call it once, as the last call. A file
  // written in place is only closed. If only the fsync of the folder fails, the file is in place,
  // but a power cut may undo the rename.
  Result<void> commit();

  // The same under another name in the same file system, for a name known only at the end
  // (a hash).
  Result<void> commit_as(const std::string& path);

  // For passing the part to another process as its standard output; ownership stays here.
  int descriptor() const noexcept { return fd_; }

 private:
  AtomicFile(int fd, std::string path, std::string part)
      : fd_(fd), path_(std::move(path)), part_(std::move(part)) {}

  int fd_;
  std::string path_;
  std::string part_;  // empty once committed or moved from, and when written in place
};

// Whether a file name (without folder) is a part that a killed process may have left.
bool is_part_name(std::string_view name) noexcept;

// Creates, writes and commits the file.
Result<void> write_file_atomically(const std::string& path, std::string_view content);

}  // namespace zonepack
