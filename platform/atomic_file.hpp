// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "platform/base/result.hpp"

namespace zonepack {

// A file that appears whole or not at all: written beside its final name as NAME.part-PID-N, then
// fsync, rename, fsync of the folder. Dropped without commit (an error, an exception), the part is
// removed and what stood under the final name is untouched. A killed process leaves its part
// behind; is_part_name() recognises one. A symbolic link stays, and its target is replaced. What is
// no regular file (a device, a pipe), and /dev/stdout, /dev/stderr and /dev/fd/N whatever they lead
// to, is written in place instead.
//
// Errors: kIo with errno. Threads: one at a time per object. Not for the control thread.
class AtomicFile {
 public:
  // Opens the part beside `path`, or what is written in place; the folder must exist.
  static Result<AtomicFile> create(std::string path);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  // Appends; unbuffered, so hand over large pieces.
  Result<void> write(std::span<const std::byte> bytes) noexcept;
  Result<void> write(std::string_view text) noexcept;

  // Makes the file durable under the name given to create(). Once, and nothing after it. What is
  // written in place is only closed.
  // If only the fsync of the folder fails, the file is in place but a power cut may undo the
  // rename.
  Result<void> commit();

  // The same under another name in the same file system, for names known only at the end (a hash).
  Result<void> commit_as(const std::string& path);

  // For handing the part to another process as its standard output; still owned here.
  int descriptor() const noexcept { return fd_; }

 private:
  AtomicFile(int fd, std::string path, std::string part)
      : fd_(fd), path_(std::move(path)), part_(std::move(part)) {}

  int fd_;
  std::string path_;
  std::string part_;  // empty once committed or moved from, and for what is written in place
};

// Whether a file name (without folder) is a part that a killed process may have left.
bool is_part_name(std::string_view name) noexcept;

// create, write, commit.
Result<void> write_file_atomically(const std::string& path, std::string_view content);

}  // namespace zonepack
