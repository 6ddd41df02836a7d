// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/arena.hpp"

#include <cstdlib>
#include <cstring>

namespace zonepack {
namespace {

constexpr std::size_t kBlockAlignment = 4096;

std::byte* allocate(std::size_t bytes) {
  const std::size_t rounded = (bytes + kBlockAlignment - 1) / kBlockAlignment * kBlockAlignment;
  auto* block = static_cast<std::byte*>(std::aligned_alloc(kBlockAlignment, rounded));
  ZP_REQUIRE(block != nullptr);
  std::memset(block, 0, rounded);
  return block;
}

}  // namespace

void Arena::Free::operator()(std::byte* block) const noexcept { std::free(block); }

Arena::Arena(std::uint32_t slots, std::size_t slot_bytes)
    : block_(slots == 0 ? nullptr : allocate(std::size_t{slots} * slot_bytes)),
      slots_(slots),
      slot_bytes_(slot_bytes) {}

}  // namespace zonepack
