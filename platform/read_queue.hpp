// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "platform/base/byte_count.hpp"
#include "platform/descriptor.hpp"

namespace zonepack {

// Reads ahead of one file at a time, past the page cache (O_DIRECT) and several requests at once
// (the kernel's asynchronous reads), into a ring of memory of its own: the disk fills it while the
// processor does something else. What could not be read so is simply not there, whatever the
// reason; who needs it reads it another way and learns why.
//
// Memory: kBytes, present from the start, in one huge page where the kernel has one, since a disk
// takes a request for one stretch of memory faster than for many pages. Threads: one.
class ReadQueue {
 public:
  static constexpr std::size_t kPieceBytes = std::size_t{256} * 1024;
  static constexpr std::size_t kPieces = 8;
  static constexpr ByteCount kBytes = kPieceBytes * kPieces;

  // Null where the kernel has no asynchronous reads (ENOSYS; aio-max-nr used up) or no memory.
  static std::unique_ptr<ReadQueue> make();
  ~ReadQueue();

  // Takes a file opened with O_DIRECT. One that was begun must have ended.
  void begin(Descriptor file) noexcept;
  bool busy() const noexcept { return file_.is_open(); }
  // Waits for what is under way, which cannot be called back, and closes the file.
  void end() noexcept;

  // Begins to read the pieces of the file that hold these bytes and are not here yet. False when
  // some found no room beside what was not passed().
  bool ask(std::uint64_t offset, std::uint64_t size) noexcept;

  // These bytes if they were asked for and could be read, after waiting for them: in the ring,
  // until passed(), or where they wrap around its end copied to `buffer`, of their size or more.
  std::optional<std::span<const std::byte>> find(std::uint64_t offset, std::size_t size,
                                                 std::span<std::byte> buffer) noexcept;

  // Nobody wants bytes before this offset any more.
  void pass(std::uint64_t offset) noexcept { oldest_ = offset / kPieceBytes; }

 private:
  struct Piece {
    enum class State : std::uint8_t { kFree, kUnderWay, kThere };
    State state = State::kFree;
    std::uint64_t number = 0;  // in the file
    std::int64_t bytes = 0;    // that came, or an error below 0
  };

  ReadQueue(unsigned long context, std::byte* ring) noexcept : context_(context), ring_(ring) {}
  void wait() noexcept;
  Piece& place_of(std::uint64_t number) noexcept { return pieces_[number % kPieces]; }

  unsigned long context_;  // aio_context_t
  std::byte* ring_;
  Descriptor file_;
  std::uint64_t oldest_ = 0;  // the first piece that somebody may still want
  std::array<Piece, kPieces> pieces_;
};

}  // namespace zonepack
