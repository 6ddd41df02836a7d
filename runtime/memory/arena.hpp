// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "platform/base/byte_count.hpp"
#include "platform/base/require.hpp"
#include "runtime/memory/slot_pool.hpp"

namespace zonepack {

// One block of memory cut into equal slots. It does not know which slot holds what.
//
// Real-time: the block is reserved once; slot() is arithmetic.
// Threads: the block itself is shared; a slot is written only by its owner (see SlotPool) and read
// by others under a generation check.
class Arena {
 public:
  // Reserves `slots` slots of `slot_bytes` each, page-aligned and zeroed, so that no page faults
  // later.
  Arena(std::uint32_t slots, std::size_t slot_bytes);

  std::span<std::byte> slot(SlotIndex index) noexcept {
    ZP_REQUIRE(index < slots_);
    return {block_.get() + std::size_t{index} * slot_bytes_, slot_bytes_};
  }
  std::span<const std::byte> slot(SlotIndex index) const noexcept {
    ZP_REQUIRE(index < slots_);
    return {block_.get() + std::size_t{index} * slot_bytes_, slot_bytes_};
  }

  std::uint32_t slot_count() const noexcept { return slots_; }
  std::size_t slot_bytes() const noexcept { return slot_bytes_; }
  ByteCount bytes() const noexcept { return ByteCount{slots_} * slot_bytes_; }

 private:
  struct Free {
    void operator()(std::byte* block) const noexcept;
  };

  std::unique_ptr<std::byte, Free> block_;
  std::uint32_t slots_;
  std::size_t slot_bytes_;
};

}  // namespace zonepack
