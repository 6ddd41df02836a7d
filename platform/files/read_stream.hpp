// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "platform/files/descriptor.hpp"

namespace zonepack {

// A file or pipe read once, from front to back, in pieces of kPieceBytes.
//
// Of a regular file, the kernel fetches the piece after the one that is being read, and no more:
// its own read-ahead, up to 8 MiB, is off. Pieces that were read are dropped from the page cache,
// where they count against the memory cgroup of the process. Other readers of the file lose them,
// too.
//
// Memory: one piece here and at most kMostPageCache in the page cache, whatever the file's length.
class ReadStream {
 public:
  static constexpr std::size_t kPieceBytes = std::size_t{64} * 1024;
  static constexpr std::size_t kDropBytes = std::size_t{128} * 1024;
  // What was read and not yet dropped, and the next piece; large folios may round up by a piece.
  static constexpr std::size_t kMostPageCache = kDropBytes + 3 * kPieceBytes;

  // kNotFound, kIo. Waits for the writer of a pipe.
  static Result<ReadStream> open(const std::string& path);

  ReadStream(ReadStream&&) noexcept = default;
  ReadStream& operator=(ReadStream&&) noexcept = default;
  ~ReadStream();

  // The next bytes, valid until the next call; none at the end. kIo.
  Result<std::span<const char>> next() noexcept;

 private:
  ReadStream(Descriptor file, bool regular) : file_(std::move(file)), regular_(regular) {}
  void drop() noexcept;

  Descriptor file_;
  bool regular_ = false;  // else there is nothing to fetch ahead or to drop
  std::uint64_t at_ = 0;
  std::uint64_t dropped_ = 0;  // of the bytes before, none are in the page cache
  std::vector<char> piece_ = std::vector<char>(kPieceBytes);
};

}  // namespace zonepack
