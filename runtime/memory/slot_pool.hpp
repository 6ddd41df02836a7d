// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "platform/base/byte_count.hpp"

namespace zonepack {

// A slot's index in the arena.
using SlotIndex = std::uint32_t;
inline constexpr SlotIndex kNoSlot = 0xFFFFFFFFu;

// Slots linked by SlotPool's table, in the order in which they are filled. A plain value whose
// holder owns the slots; count is always the number of slots from head to tail.
struct SlotChain {
  SlotIndex head = kNoSlot;
  SlotIndex tail = kNoSlot;
  std::uint32_t count = 0;
};

// The free slots of an arena, and the links of all chains: one u32 per slot. A slot given back is
// reused last, which gives a slow reader the longest time to notice.
//
// Invariant: every slot is on the free list or in exactly one chain that was taken and not given
// back.
// Real-time: no allocation after construction; take_one and give_back are O(1).
// Threads: owned by the thread that fills slots (the loader's); control passes chains, never links.
class SlotPool {
 public:
  explicit SlotPool(std::uint32_t slots);
  // Keeps its links in memory that outlives it, so that others can follow chains: one per slot.
  explicit SlotPool(std::span<SlotIndex> links);
  SlotPool(const SlotPool&) = delete;
  SlotPool& operator=(const SlotPool&) = delete;

  // Moves one free slot to the end of `chain`; false when none is free.
  bool take_one(SlotChain& chain) noexcept;

  // Moves `count` free slots to the end of `chain`, or none when fewer are free. O(count).
  bool take(std::uint32_t count, SlotChain& chain) noexcept;

  // Appends the whole chain to the free list and leaves it empty.
  void give_back(SlotChain& chain) noexcept;

  // The slot after `slot` in its chain; kNoSlot after the last.
  SlotIndex next(SlotIndex slot) const noexcept { return next_[slot]; }

  std::uint32_t free_count() const noexcept { return free_.count; }
  std::uint32_t slot_count() const noexcept { return static_cast<std::uint32_t>(next_.size()); }

  // What a pool of this many slots takes from the budget besides the slots themselves.
  static ByteCount table_bytes(std::uint32_t slots) noexcept { return ByteCount{4} * slots; }

 private:
  void free_all() noexcept;

  std::vector<SlotIndex> own_;
  std::span<SlotIndex> next_;
  SlotChain free_;
};

}  // namespace zonepack
