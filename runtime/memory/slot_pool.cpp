// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/slot_pool.hpp"

#include "platform/base/require.hpp"

namespace zonepack {

SlotPool::SlotPool(std::uint32_t slots) : own_(slots), next_(own_) { free_all(); }

SlotPool::SlotPool(std::span<SlotIndex> links) : next_(links) { free_all(); }

void SlotPool::free_all() noexcept {
  ZP_REQUIRE(next_.size() < kNoSlot);
  const auto slots = static_cast<std::uint32_t>(next_.size());
  if (slots == 0) return;
  for (SlotIndex i = 0; i + 1 < slots; ++i) next_[i] = i + 1;
  next_[slots - 1] = kNoSlot;
  free_ = {0, slots - 1, slots};
}

bool SlotPool::take_one(SlotChain& chain) noexcept {
  if (free_.count == 0) return false;
  const SlotIndex slot = free_.head;
  free_.head = next_[slot];
  if (--free_.count == 0) free_ = {};
  next_[slot] = kNoSlot;
  if (chain.count == 0) {
    chain.head = slot;
  } else {
    next_[chain.tail] = slot;
  }
  chain.tail = slot;
  ++chain.count;
  return true;
}

bool SlotPool::take(std::uint32_t count, SlotChain& chain) noexcept {
  if (count > free_.count) return false;
  for (std::uint32_t i = 0; i < count; ++i) take_one(chain);
  return true;
}

void SlotPool::give_back(SlotChain& chain) noexcept {
  if (chain.count == 0) return;
  ZP_REQUIRE(chain.head < next_.size() && chain.tail < next_.size());
  ZP_REQUIRE(next_[chain.tail] == kNoSlot);
  if (free_.count == 0) {
    free_ = chain;
  } else {
    next_[free_.tail] = chain.head;
    free_.tail = chain.tail;
    free_.count += chain.count;
  }
  chain = {};
}

}  // namespace zonepack
