// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>

#include "platform/base/require.hpp"

namespace zonepack {

// Messages of any length in a ring of fixed size, between one thread that pushes and one that pops.
//
// Real-time: all memory is taken, and touched, in the constructor; push() copies and never waits.
// Threads: push() by one, pop() and next_size() by another.
class ByteRing {
 public:
  // capacity: bytes for messages and four for the length of each; rounded up to a power of two.
  explicit ByteRing(std::size_t capacity)
      : capacity_(std::bit_ceil(capacity)), bytes_(std::make_unique<std::byte[]>(capacity_)) {
    ZP_REQUIRE(capacity >= 64 && capacity <= (std::size_t{1} << 30));
  }

  // Appends the two parts as one message; false when there is no room, and nothing is written.
  bool push(std::span<const std::byte> first, std::span<const std::byte> second) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    const std::size_t used = tail - head_.load(std::memory_order_acquire);
    const std::size_t size = first.size() + second.size();
    if (size > capacity_ || sizeof(std::uint32_t) + size > capacity_ - used) return false;
    const auto length = static_cast<std::uint32_t>(size);
    put(tail, std::as_bytes(std::span(&length, 1)));
    put(tail + sizeof length, first);
    put(tail + sizeof length + first.size(), second);
    tail_.store(tail + sizeof length + size, std::memory_order_release);
    return true;
  }

  // Length of the next message; 0 when there is none (no message is empty).
  std::size_t next_size() const noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return 0;
    std::uint32_t length = 0;
    get(head, std::as_writable_bytes(std::span(&length, 1)));
    return length;
  }

  // Takes the next message, which must exist and be as long as `into`.
  void pop(std::span<std::byte> into) noexcept {
    ZP_REQUIRE(into.size() == next_size());
    const std::size_t head = head_.load(std::memory_order_relaxed);
    get(head + sizeof(std::uint32_t), into);
    head_.store(head + sizeof(std::uint32_t) + into.size(), std::memory_order_release);
  }

  std::size_t capacity() const noexcept { return capacity_; }

 private:
  void put(std::size_t at, std::span<const std::byte> from) noexcept {
    const std::size_t place = at & (capacity_ - 1);
    const std::size_t part = std::min(from.size(), capacity_ - place);
    if (part > 0) std::memcpy(bytes_.get() + place, from.data(), part);
    if (part < from.size()) std::memcpy(bytes_.get(), from.data() + part, from.size() - part);
  }
  void get(std::size_t at, std::span<std::byte> into) const noexcept {
    const std::size_t place = at & (capacity_ - 1);
    const std::size_t part = std::min(into.size(), capacity_ - place);
    if (part > 0) std::memcpy(into.data(), bytes_.get() + place, part);
    if (part < into.size()) std::memcpy(into.data() + part, bytes_.get(), into.size() - part);
  }

  const std::size_t capacity_;
  const std::unique_ptr<std::byte[]> bytes_;
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
};

}  // namespace zonepack
