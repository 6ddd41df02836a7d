// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "platform/base/byte_count.hpp"
#include "platform/files/descriptor.hpp"

namespace zonepack {

// Reads ahead in one file at a time, bypassing the page cache (O_DIRECT) and with several requests
// at once (the kernel's asynchronous reads), into a ring of its own: the disk fills it while the
// processor does other work. Bytes that could not be read are just not there, whatever the reason;
// the caller reads them another way and gets the error there.
//
// Memory: kBytes, present from the start, in one huge page where the kernel has one, since a disk
// serves a request for one stretch of memory faster than one for many pages.
// Threads: one.
class ReadQueue {
 public:
  static constexpr std::size_t kPieceBytes = std::size_t{256} * 1024;
  static constexpr std::size_t kPieces = 8;
  static constexpr ByteCount kBytes = kPieceBytes * kPieces;

  // Null where the kernel has no asynchronous reads (ENOSYS; aio-max-nr used up) or no memory.
  static std::unique_ptr<ReadQueue> make();
  ~ReadQueue();

  // Takes a file opened with O_DIRECT. A previous begin() must have been ended.
  void begin(Descriptor file) noexcept;
  bool busy() const noexcept { return file_.is_open(); }
  // Waits for the reads under way, which cannot be cancelled, and closes the file.
  void end() noexcept;

  // Starts reading the pieces of the file that hold these bytes and are not here yet. False when
  // the ring has no room for some of them next to the pieces that have not been passed.
  bool ask(std::uint64_t offset, std::uint64_t size) noexcept;

  // Waits for these bytes and returns them, if they were asked for and could be read. They are in
  // the ring until passed or, where they wrap around its end, in `buffer`, which must hold `size`
  // bytes.
  std::optional<std::span<const std::byte>> find(std::uint64_t offset, std::size_t size,
                                                 std::span<std::byte> buffer) noexcept;

  // Gives up all bytes before this offset.
  void pass(std::uint64_t offset) noexcept { oldest_ = offset / kPieceBytes; }

 private:
  struct Piece {
    enum class State : std::uint8_t { kFree, kUnderWay, kThere };
    State state = State::kFree;
    std::uint64_t number = 0;  // in the file
    std::int64_t bytes = 0;    // read, or a negative error
  };

  ReadQueue(unsigned long context, std::byte* ring) noexcept : context_(context), ring_(ring) {}
  void wait() noexcept;
  Piece& place_of(std::uint64_t number) noexcept { return pieces_[number % kPieces]; }

  unsigned long context_;  // aio_context_t
  std::byte* ring_;
  Descriptor file_;
  std::uint64_t oldest_ = 0;  // the first piece that may still be wanted
  std::array<Piece, kPieces> pieces_;
};

}  // namespace zonepack
