// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace zonepack {

// The newest value of one writer, for any number of readers that never delay it.
//
// Real-time: store() copies the value; load() retries while a store() is running.
// Threads: store() by one, load() by any.
template <typename T>
class Seqlock {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  void store(const T& value) noexcept {
    Words words{};
    std::memcpy(words.data, &value, sizeof value);
    const std::uint32_t turn = turn_.load(std::memory_order_relaxed);
    turn_.store(turn + 1, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    for (std::size_t i = 0; i < kWords; ++i) {
      words_[i].store(words.data[i], std::memory_order_relaxed);
    }
    turn_.store(turn + 2, std::memory_order_release);
  }

  T load() const noexcept {
    for (;;) {
      Words words;
      const std::uint32_t before = turn_.load(std::memory_order_acquire);
      for (std::size_t i = 0; i < kWords; ++i) {
        words.data[i] = words_[i].load(std::memory_order_relaxed);
      }
      std::atomic_thread_fence(std::memory_order_acquire);
      if ((before & 1) != 0 || turn_.load(std::memory_order_relaxed) != before) continue;
      T value;
      std::memcpy(&value, words.data, sizeof value);
      return value;
    }
  }

 private:
  static constexpr std::size_t kWords = (sizeof(T) + 3) / 4;
  struct Words {
    std::uint32_t data[kWords];
  };

  std::atomic<std::uint32_t> turn_{0};
  std::atomic<std::uint32_t> words_[kWords] = {};
};

}  // namespace zonepack
