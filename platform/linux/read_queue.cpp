// SPDX-License-Identifier: Apache-2.0
#include "platform/files/read_queue.hpp"

#include <linux/aio_abi.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "platform/base/require.hpp"
#include "platform/linux/populate.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kRingBytes = ReadQueue::kBytes;  // also a huge page's size and alignment

// Memory aligned for a huge page.
std::byte* map_ring() noexcept {
  void* const mapped =
      ::mmap(nullptr, 2 * kRingBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) return nullptr;
  auto* const begin = static_cast<std::byte*>(mapped);
  const std::size_t before =
      (kRingBytes - reinterpret_cast<std::uintptr_t>(begin) % kRingBytes) % kRingBytes;
  if (before > 0) ::munmap(begin, before);
  std::byte* const ring = begin + before;
  ::munmap(ring + kRingBytes, kRingBytes - before);
  ::madvise(ring, kRingBytes, MADV_HUGEPAGE);
  populate(ring, kRingBytes);
  return ring;
}

}  // namespace

std::unique_ptr<ReadQueue> ReadQueue::make() {
  aio_context_t context = 0;
  if (::syscall(SYS_io_setup, kPieces, &context) != 0) return nullptr;
  if (std::byte* const ring = map_ring()) {
    return std::unique_ptr<ReadQueue>(new ReadQueue(context, ring));
  }
  ::syscall(SYS_io_destroy, context);
  return nullptr;
}

ReadQueue::~ReadQueue() {
  end();
  ::syscall(SYS_io_destroy, context_);
  ::munmap(ring_, kRingBytes);
}

void ReadQueue::begin(Descriptor file) noexcept {
  ZP_REQUIRE(!busy());
  file_ = std::move(file);
  oldest_ = 0;
}

void ReadQueue::end() noexcept {
  for (Piece& piece : pieces_) {
    while (piece.state == Piece::State::kUnderWay) wait();
    piece.state = Piece::State::kFree;
  }
  file_ = Descriptor();
}

bool ReadQueue::ask(std::uint64_t offset, std::uint64_t size) noexcept {
  if (size == 0) return true;
  std::array<iocb, kPieces> requests{};
  std::array<iocb*, kPieces> wanted;
  std::size_t count = 0;
  bool room = true;
  const std::uint64_t last = (offset + size - 1) / kPieceBytes;
  for (std::uint64_t number = offset / kPieceBytes; number <= last && room; ++number) {
    Piece& piece = place_of(number);
    if (piece.state != Piece::State::kFree && piece.number == number) continue;
    room = piece.state == Piece::State::kFree ||
           (piece.state == Piece::State::kThere && piece.number < oldest_);
    if (!room) break;
    iocb& request = requests[count];
    request.aio_data = number % kPieces;
    request.aio_lio_opcode = IOCB_CMD_PREAD;
    request.aio_fildes = static_cast<std::uint32_t>(file_.get());
    request.aio_buf = reinterpret_cast<std::uintptr_t>(ring_ + number % kPieces * kPieceBytes);
    request.aio_nbytes = kPieceBytes;
    request.aio_offset = static_cast<std::int64_t>(number * kPieceBytes);
    wanted[count++] = &request;
    piece = {Piece::State::kUnderWay, number, 0};
  }
  long begun = count == 0 ? 0 : ::syscall(SYS_io_submit, context_, count, wanted.data());
  // A read that the kernel does not accept now counts as failed.
  for (auto i = static_cast<std::size_t>(std::max(begun, 0L)); i < count; ++i) {
    place_of(requests[i].aio_data).state = Piece::State::kThere;
    place_of(requests[i].aio_data).bytes = -EAGAIN;
  }
  return room;
}

void ReadQueue::wait() noexcept {
  std::array<io_event, kPieces> events;
  long came = 0;
  do {
    came = ::syscall(SYS_io_getevents, context_, 1, kPieces, events.data(), nullptr);
  } while (came < 0 && errno == EINTR);
  ZP_REQUIRE(came > 0);
  for (long i = 0; i < came; ++i) {
    Piece& piece = place_of(events[static_cast<std::size_t>(i)].data);
    piece.state = Piece::State::kThere;
    piece.bytes = events[static_cast<std::size_t>(i)].res;
  }
}

std::optional<std::span<const std::byte>> ReadQueue::find(std::uint64_t offset, std::size_t size,
                                                          std::span<std::byte> buffer) noexcept {
  const std::uint64_t end = offset + size;
  for (std::uint64_t number = offset / kPieceBytes; number * kPieceBytes < end; ++number) {
    const Piece& piece = place_of(number);
    if (piece.state == Piece::State::kFree || piece.number != number) return std::nullopt;
    while (piece.state == Piece::State::kUnderWay) wait();
    const std::uint64_t wanted = std::min(end - number * kPieceBytes, std::uint64_t{kPieceBytes});
    if (piece.bytes < static_cast<std::int64_t>(wanted)) return std::nullopt;
  }
  const auto at = static_cast<std::size_t>(offset % kBytes);
  const std::size_t before_wrap = std::min(size, kRingBytes - at);
  if (before_wrap == size) return std::span<const std::byte>(ring_ + at, size);
  std::memcpy(buffer.data(), ring_ + at, before_wrap);
  std::memcpy(buffer.data() + before_wrap, ring_, size - before_wrap);
  return std::span<const std::byte>(buffer.first(size));
}

}  // namespace zonepack
