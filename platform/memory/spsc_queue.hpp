// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <type_traits>

#include "platform/base/require.hpp"

namespace zonepack {

// A queue of fixed size between one thread that pushes and one that pops.
//
// Real-time: the constructor allocates and touches all memory; push and pop copy one item and never
// wait.
// Threads: push() and free_space() by one, pop() and peek() by another, size() by any.
template <typename T>
class SpscQueue {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit SpscQueue(std::size_t capacity)
      : capacity_(capacity), items_(std::make_unique<T[]>(capacity)) {
    ZP_REQUIRE(capacity > 0);
  }
  SpscQueue(const SpscQueue&) = delete;
  SpscQueue& operator=(const SpscQueue&) = delete;

  // False when full; nothing is overwritten.
  bool push(const T& item) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - head_.load(std::memory_order_acquire) == capacity_) return false;
    items_[tail % capacity_] = item;
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  // False when empty.
  bool pop(T& item) noexcept {
    const T* const next = peek();
    if (next == nullptr) return false;
    item = *next;
    head_.store(head_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    return true;
  }

  // The next item, valid until it is popped; null when empty.
  const T* peek() const noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return nullptr;
    return &items_[head % capacity_];
  }

  std::size_t size() const noexcept {
    const std::size_t head = head_.load(std::memory_order_acquire);
    return tail_.load(std::memory_order_acquire) - head;
  }
  std::size_t free_space() const noexcept { return capacity_ - size(); }
  std::size_t capacity() const noexcept { return capacity_; }

 private:
  const std::size_t capacity_;
  const std::unique_ptr<T[]> items_;
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
};

}  // namespace zonepack
