// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "packer/record/record.hpp"
#include "runtime/pack_format/voxel_block.hpp"

namespace zonepack::packer {

// Values of a plane, at most 512.
struct VoxelList {
  VoxelPlane::Values values;
  std::size_t size = 0;
  std::span<const std::uint32_t> all() const { return {values.data(), size}; }
  void push(std::uint32_t value) { values[size++] = value; }
};

// The distinct values of a list and how often each occurs, in order of first occurrence.
class VoxelCensus {
 public:
  explicit VoxelCensus(std::span<const std::uint32_t> values) {
    table_.fill(kNone);
    for (const std::uint32_t value : values) ++counts_[place_of(value)];
  }
  std::size_t size() const { return size_; }
  std::uint32_t name(std::size_t i) const { return names_[i]; }
  std::uint32_t count(std::size_t i) const { return counts_[i]; }

  // The values that occur most, the earlier of equals first.
  template <std::size_t N>
  std::array<std::uint32_t, N> most_frequent() const {
    std::array<std::uint32_t, N> out{};
    std::array<std::uint32_t, N> times{};
    for (std::size_t i = 0; i < size_; ++i) {
      std::uint32_t value = names_[i], count = counts_[i];
      for (std::size_t k = 0; k < N; ++k) {
        if (count <= times[k]) continue;
        std::swap(value, out[k]);
        std::swap(count, times[k]);
      }
    }
    return out;
  }

 private:
  std::size_t place_of(std::uint32_t value) {
    std::size_t at = (value * 0x9E3779B1u) >> 22;
    for (; table_[at] != kNone; at = (at + 1) & (table_.size() - 1)) {
      if (names_[table_[at]] == value) return table_[at];
    }
    table_[at] = static_cast<std::uint16_t>(size_);
    names_[size_] = value;
    counts_[size_] = 0;
    return size_++;
  }

  static constexpr std::uint16_t kNone = 0xFFFF;
  std::array<std::uint16_t, 1024> table_;
  std::array<std::uint32_t, kVoxelsOfBlock> names_;
  std::array<std::uint32_t, kVoxelsOfBlock> counts_;
  std::size_t size_ = 0;
};

// A list's smallest form, and what it takes.
struct ListForm {
  VoxelForm form = VoxelForm::kRaw;
  VoxelOrder order = VoxelOrder::kUnsigned;
  std::uint32_t base = 0;
  unsigned bits = 32, fraction = 0, low_zeros = 0;
  std::array<std::uint16_t, kMostHeads> heads{};
  std::size_t head_count = 0;
  std::array<std::uint8_t, 4> byte_base{}, byte_bits{};
  std::size_t bytes = std::numeric_limits<std::size_t>::max();

  void offer(const ListForm& other) {
    if (other.bytes < bytes) *this = other;
  }
};

// Which of the forms of FORMAT.md ("Planes") restores all bits of the list in the fewest bytes.
ListForm smallest_form(const VoxelList& list, const VoxelCensus& census);

// Appends what the form says of itself, and the list in it.
void write_form(const ListForm& form, const VoxelList& list, Bytes& out);

// Appends a number of one byte.
void put_u8(std::size_t value, Bytes& out);

}  // namespace zonepack::packer
