// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/voxel_block.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "runtime/pack_format/column.hpp"

namespace zonepack {
namespace {

constexpr std::uint32_t kMantissaBits = 23;

bool bit_at(const std::byte* bits, std::uint32_t index) noexcept {
  return (std::to_integer<unsigned>(bits[index >> 3]) >> (index & 7) & 1) != 0;
}

std::uint64_t word_at(const std::byte* bits, std::uint32_t word) noexcept {
  std::uint64_t value;
  std::memcpy(&value, bits + std::size_t{word} * 8, sizeof value);
  return value;
}

// Set bits among the first `count`, of one bitmap or of both together. Reads up to 7 bytes behind.
std::uint32_t rank(const std::byte* bits, const std::byte* with, std::uint32_t count) noexcept {
  std::uint32_t sum = 0;
  for (std::uint32_t word = 0; word * 64 < count; ++word) {
    std::uint64_t value = word_at(bits, word);
    if (with != nullptr) value &= word_at(with, word);
    const std::uint32_t left = count - word * 64;
    if (left < 64) value &= (std::uint64_t{1} << left) - 1;
    sum += static_cast<std::uint32_t>(std::popcount(value));
  }
  return sum;
}

constexpr std::uint32_t bitmap_bytes(std::uint32_t bits) noexcept { return (bits + 7) / 8; }

// Whether bits behind the first `count` of a bitmap are clear.
bool ends_clear(const std::byte* bits, std::uint64_t count) noexcept {
  return count % 8 == 0 || std::to_integer<unsigned>(bits[count / 8]) >> (count % 8) == 0;
}

std::uint32_t from_ordered(VoxelOrder order, std::uint32_t ordered) noexcept {
  switch (order) {
    case VoxelOrder::kInt:
      return ordered ^ 0x80000000u;
    case VoxelOrder::kFloat:
      return float_from_ordered(ordered);
    case VoxelOrder::kUnsigned:
      break;
  }
  return ordered;
}

constexpr std::uint32_t index_bits(std::uint32_t count) noexcept {
  return static_cast<std::uint32_t>(std::bit_width(count - 1));
}

}  // namespace

// Reads the planes of a block one after the other.
class VoxelBlockReader {
 public:
  explicit VoxelBlockReader(ByteSpan bytes) noexcept : bytes_(bytes) {}

  bool read(VoxelPlane& plane, const VoxelPlane* before) noexcept {
    std::uint8_t head = 0, form = 0;
    if (!take(head) || !take(form) || head >> 4 != 0 ||
        form > static_cast<std::uint8_t>(VoxelForm::kBytes)) {
      return false;
    }
    plane.spread_ = static_cast<VoxelSpread>(head & 3);
    plane.choice_ = static_cast<VoxelChoice>(head >> 2 & 3);
    plane.form_ = static_cast<VoxelForm>(form);
    return spread(plane, before) && choice(plane, before) && list(plane);
  }
  bool at_end() const noexcept { return bytes_.empty(); }

 private:
  template <typename T>
  bool take(T& value) noexcept {
    if (bytes_.size() < sizeof value) return false;
    value = read_once<T>(bytes_.data());
    bytes_ = bytes_.subspan(sizeof value);
    return true;
  }

  const std::byte* take_bytes(std::uint32_t count) noexcept {
    if (bytes_.size() < count) return nullptr;
    const std::byte* const at = bytes_.data();
    bytes_ = bytes_.subspan(count);
    return at;
  }

  bool spread(VoxelPlane& plane, const VoxelPlane* before) noexcept {
    switch (plane.spread_) {
      case VoxelSpread::kEach:
        plane.runs_ = kVoxelsOfBlock;
        return true;
      case VoxelSpread::kColumns:
        plane.runs_ = kVoxelsOfBlock / kBlockSide;
        return true;
      case VoxelSpread::kRuns:
        plane.starts_ = take_bytes(bitmap_bytes(kVoxelsOfBlock));
        if (plane.starts_ == nullptr || !bit_at(plane.starts_, 0)) return false;
        plane.runs_ = rank(plane.starts_, nullptr, kVoxelsOfBlock);
        return plane.runs_ > 0;
      case VoxelSpread::kAsBefore:
        break;
    }
    if (before == nullptr || before->spread_ != VoxelSpread::kRuns) return false;
    plane.spread_ = VoxelSpread::kRuns;
    plane.starts_ = before->starts_;
    plane.runs_ = before->runs_;
    return true;
  }

  bool choice(VoxelPlane& plane, const VoxelPlane* before) noexcept {
    const bool as_before = plane.choice_ == VoxelChoice::kAsBefore;
    if (as_before) {
      if (before == nullptr || before->choice_ == VoxelChoice::kNone ||
          before->runs_ != plane.runs_) {
        return false;
      }
      plane.choice_ = before->choice_;
    }
    if (plane.choice_ == VoxelChoice::kNone) {
      plane.listed_ = plane.runs_;
      return true;
    }
    const std::size_t constants = plane.choice_ == VoxelChoice::kOneOfTwo ? 1 : 3;
    for (std::size_t i = 0; i < constants; ++i) {
      if (!take(plane.constants_[i])) return false;
    }
    if (as_before) {
      plane.low_ = before->low_;
      plane.high_ = before->high_;
      plane.listed_ = before->listed_;
      return true;
    }
    plane.low_ = take_bytes(bitmap_bytes(plane.runs_));
    if (constants == 3) plane.high_ = take_bytes(bitmap_bytes(plane.runs_));
    if (plane.low_ == nullptr || (constants == 3 && plane.high_ == nullptr)) return false;
    plane.listed_ = rank(plane.low_, plane.high_, plane.runs_);
    return true;
  }

  bool list(VoxelPlane& plane) noexcept {
    if (!form(plane)) return false;
    if (plane.form_ == VoxelForm::kConstant) return true;
    const std::uint32_t bits = plane.width();
    plane.list_ = take_bytes((plane.listed_ * bits + 7) / 8);
    return plane.list_ != nullptr;
  }

  bool form(VoxelPlane& plane) noexcept {
    std::uint8_t count = 0;
    switch (plane.form_) {
      case VoxelForm::kConstant:
        return take(plane.base_);
      case VoxelForm::kRaw:
        return true;
      case VoxelForm::kPacked: {
        std::uint8_t order = 0;
        if (!take(order) || order > 2 || !take(plane.bits_) || plane.bits_ > 32) return false;
        plane.order_ = static_cast<VoxelOrder>(order);
        return take(plane.base_);
      }
      case VoxelForm::kScaled:
        return take(plane.fraction_) && plane.fraction_ <= 15 && take(plane.bits_) &&
               plane.bits_ <= 25 && take(plane.base_);
      case VoxelForm::kDictionary:
        if (!take(count)) return false;
        plane.table_size_ = count + 1U;
        plane.bits_ = static_cast<std::uint8_t>(index_bits(plane.table_size_));
        plane.table_ = take_bytes(plane.table_size_ * 4);
        return plane.table_ != nullptr;
      case VoxelForm::kFloat:
        if (!take(count) || count >= kMostHeads || !take(plane.low_zeros_) ||
            plane.low_zeros_ > kMantissaBits) {
          return false;
        }
        plane.table_size_ = count + 1U;
        plane.head_bits_ = static_cast<std::uint8_t>(index_bits(plane.table_size_));
        for (std::uint32_t i = 0; i <= count; ++i) {
          if (!take(plane.heads_[i])) return false;
        }
        return true;
      case VoxelForm::kBytes:
        for (std::size_t i = 0; i < 4; ++i) {
          if (!take(plane.byte_base_[i]) || !take(plane.byte_bits_[i]) || plane.byte_bits_[i] > 8) {
            return false;
          }
        }
        return true;
    }
    return false;
  }

  ByteSpan bytes_;
};

std::uint32_t VoxelPlane::width() const noexcept {
  switch (form_) {
    case VoxelForm::kConstant:
      return 0;
    case VoxelForm::kRaw:
      return 32;
    case VoxelForm::kFloat:
      return head_bits_ + kMantissaBits - low_zeros_;
    case VoxelForm::kBytes:
      return std::uint32_t{byte_bits_[0]} + byte_bits_[1] + byte_bits_[2] + byte_bits_[3];
    default:
      return bits_;
  }
}

std::uint32_t VoxelPlane::value(std::uint32_t place) const noexcept {
  if (form_ == VoxelForm::kConstant) return base_;
  if (place >= listed_) return 0;  // changed since it was parsed
  const std::uint32_t bits = packed_at(list_, place, width());
  switch (form_) {
    case VoxelForm::kPacked:
      return from_ordered(order_, base_ + bits);
    case VoxelForm::kScaled: {
      const std::int64_t k = std::int64_t{static_cast<std::int32_t>(base_)} + bits;
      const float scale = 1.0F / static_cast<float>(1U << fraction_);
      return std::bit_cast<std::uint32_t>(static_cast<float>(k) * scale);
    }
    case VoxelForm::kDictionary: {
      if (bits >= table_size_) return 0;
      std::uint32_t value;
      std::memcpy(&value, table_ + std::size_t{bits} * 4, sizeof value);
      return value;
    }
    case VoxelForm::kFloat: {
      const std::uint32_t mantissa_bits = kMantissaBits - low_zeros_;
      const std::uint32_t mantissa = bits & ((1U << mantissa_bits) - 1);
      const std::uint32_t head = bits >> mantissa_bits;
      return std::uint32_t{heads_[head & (kMostHeads - 1)]} << kMantissaBits | mantissa
                                                                                   << low_zeros_;
    }
    case VoxelForm::kBytes: {
      std::uint32_t value = 0, at = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        const std::uint32_t part =
            static_cast<std::uint32_t>(std::uint64_t{bits} >> at) & ((1U << byte_bits_[i]) - 1);
        value |= ((byte_base_[i] + part) & 0xFFU) << (8 * i);
        at += byte_bits_[i];
      }
      return value;
    }
    default:
      return bits;
  }
}

std::uint32_t VoxelPlane::at(std::uint32_t voxel) const noexcept {
  std::uint32_t place = voxel & (kVoxelsOfBlock - 1);
  if (spread_ == VoxelSpread::kColumns) place /= kBlockSide;
  if (spread_ == VoxelSpread::kRuns) place = rank(starts_, nullptr, place + 1) - 1;
  if (place >= runs_) return 0;
  if (choice_ == VoxelChoice::kNone) return value(place);
  const std::uint32_t code =
      bit_at(low_, place) + (high_ != nullptr ? 2U * bit_at(high_, place) : 0U);
  if (code != (high_ != nullptr ? 3U : 1U)) return constants_[code];
  return value(rank(low_, high_, place));
}

void VoxelPlane::copy_list(Values& out) const noexcept {
  for (std::uint32_t i = 0; i < listed_; ++i) out[i] = value(i);
}

void VoxelPlane::copy(Values& out) const noexcept {
  if (form_ == VoxelForm::kConstant && choice_ == VoxelChoice::kNone) {
    out.fill(base_);
    return;
  }
  Values list, chosen;
  copy_list(list);
  const Values* values = &list;
  if (choice_ != VoxelChoice::kNone) {
    const std::uint32_t next_code = high_ != nullptr ? 3U : 1U;
    std::uint32_t next = 0;
    for (std::uint32_t i = 0; i < runs_; ++i) {
      const std::uint32_t code = bit_at(low_, i) + (high_ != nullptr ? 2U * bit_at(high_, i) : 0U);
      if (code != next_code) {
        chosen[i] = constants_[code];
      } else {
        chosen[i] = next < listed_ ? list[next] : 0;
        ++next;
      }
    }
    values = &chosen;
  }
  switch (spread_) {
    case VoxelSpread::kColumns:
      for (std::uint32_t i = 0; i < kVoxelsOfBlock; ++i) out[i] = (*values)[i / kBlockSide];
      return;
    case VoxelSpread::kRuns: {
      std::uint32_t begun = 0;
      for (std::uint32_t i = 0; i < kVoxelsOfBlock; ++i) {
        begun += bit_at(starts_, i);
        out[i] = begun - 1 < runs_ ? (*values)[begun - 1] : 0;
      }
      return;
    }
    default:
      out = *values;
  }
}

bool VoxelPlane::is_exact() const noexcept {
  if (choice_ != VoxelChoice::kNone &&
      (!ends_clear(low_, runs_) || (high_ != nullptr && !ends_clear(high_, runs_)))) {
    return false;
  }
  if (form_ == VoxelForm::kConstant) return true;
  if (!ends_clear(list_, std::uint64_t{listed_} * width())) return false;
  if (form_ != VoxelForm::kDictionary && form_ != VoxelForm::kFloat) return true;
  const std::uint32_t shift = form_ == VoxelForm::kFloat ? kMantissaBits - low_zeros_ : 0;
  for (std::uint32_t i = 0; i < listed_; ++i) {
    if (packed_at(list_, i, width()) >> shift >= table_size_) return false;
  }
  return std::ranges::all_of(heads_, [](std::uint16_t head) { return head < 512; });
}

bool parse_block(ByteSpan bytes, std::uint32_t planes, VoxelPlanes& out) noexcept {
  VoxelBlockReader reader(bytes);
  if (planes > kMostPlanes) return false;
  for (std::uint32_t i = 0; i < planes; ++i) {
    out[i] = VoxelPlane();
    if (!reader.read(out[i], i == 0 ? nullptr : &out[i - 1])) return false;
  }
  return reader.at_end();
}

bool copy_block(ByteSpan bytes, std::uint32_t planes, std::span<std::byte> out) noexcept {
  VoxelPlanes parsed;
  if (out.size() != bytes_of_block(planes) || !parse_block(bytes, planes, parsed)) return false;
  VoxelPlane::Values values;
  for (std::uint32_t p = 0; p < planes; ++p) {
    parsed[p].copy(values);
    std::byte* at = out.data() + std::size_t{p} * 4;
    for (const std::uint32_t value : values) {
      std::memcpy(at, &value, sizeof value);
      at += std::size_t{planes} * 4;
    }
  }
  return true;
}

ByteSpan block_at(ByteSpan column, std::uint32_t rows, std::uint32_t row) noexcept {
  const std::size_t heads = std::size_t{rows} * sizeof(std::uint16_t);
  if (row >= rows || heads > column.size()) return {};
  const auto end_of = [&](std::uint32_t i) {
    return std::size_t{read_once<std::uint16_t>(column.data() + std::size_t{i} * 2)};
  };
  const std::size_t begin = row == 0 ? 0 : end_of(row - 1);
  const std::size_t end = end_of(row);
  if (begin > end || end > column.size() - heads) return {};
  return column.subspan(heads + begin, end - begin);
}

namespace {

template <typename Test>
bool every_block(ByteSpan column, std::uint32_t rows, std::uint32_t planes, Test&& test) noexcept {
  const std::size_t heads = std::size_t{rows} * sizeof(std::uint16_t);
  if (planes == 0 || planes > kMostPlanes || heads > column.size()) return false;
  std::size_t filled = heads;
  VoxelPlanes parsed;
  for (std::uint32_t row = 0; row < rows; ++row) {
    const ByteSpan block = block_at(column, rows, row);
    filled += block.size();
    if (!parse_block(block, planes, parsed)) return false;
    for (std::uint32_t p = 0; p < planes; ++p) {
      if (!test(parsed[p])) return false;
    }
  }
  return filled == column.size();
}

constexpr std::uint32_t spread3(std::uint32_t v) noexcept {
  return (v & 1) | (v & 2) << 2 | (v & 4) << 4;
}

constexpr std::uint32_t gather3(std::uint32_t v) noexcept {
  return (v & 1) | (v >> 2 & 2) | (v >> 4 & 4);
}

}  // namespace

bool planes_are_sound(ByteSpan column, std::uint32_t rows, std::uint32_t planes) noexcept {
  return every_block(column, rows, planes, [](const VoxelPlane&) { return true; });
}

bool planes_are_exact(ByteSpan column, std::uint32_t rows, std::uint32_t planes) noexcept {
  return every_block(column, rows, planes, [](const VoxelPlane& p) { return p.is_exact(); });
}

std::uint32_t place_in_cube(std::uint32_t x, std::uint32_t y, std::uint32_t z) noexcept {
  return spread3(x) | spread3(y) << 1 | spread3(z) << 2;
}

std::array<std::uint32_t, 3> xyz_of_place(std::uint32_t place) noexcept {
  return {gather3(place), gather3(place >> 1), gather3(place >> 2)};
}

}  // namespace zonepack
