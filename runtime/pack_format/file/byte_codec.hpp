// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "platform/base/byte_span.hpp"

// The numbers of recordings, saved states and learned transitions. Fixed ones are little endian; a
// varint holds seven bits per byte, lowest first, the top bit set on all bytes but the last; signed
// ones are zigzag (0, -1, 1, -2 ...).
// Real-time: no allocation.
namespace zonepack {

// Writes into a buffer of fixed size. What does not fit is left out and ok() is false from then on.
class ByteWriter {
 public:
  static constexpr std::size_t kLongestVarint = 10;

  explicit ByteWriter(std::span<std::byte> buffer) noexcept : buffer_(buffer) {}

  bool ok() const noexcept { return ok_; }
  std::size_t size() const noexcept { return size_; }
  ByteSpan written() const noexcept { return buffer_.first(size_); }

  void u8(std::uint8_t value) noexcept {
    if (std::byte* const at = take(1)) *at = static_cast<std::byte>(value);
  }
  void u16(std::uint16_t value) noexcept { fixed(value, 2); }
  void u32(std::uint32_t value) noexcept { fixed(value, 4); }
  void u64(std::uint64_t value) noexcept { fixed(value, 8); }
  void i64(std::int64_t value) noexcept { fixed(static_cast<std::uint64_t>(value), 8); }
  void f64(double value) noexcept { fixed(std::bit_cast<std::uint64_t>(value), 8); }
  void varint(std::uint64_t value) noexcept {
    for (; value >= 0x80; value >>= 7) u8(static_cast<std::uint8_t>(value | 0x80));
    u8(static_cast<std::uint8_t>(value));
  }
  void zigzag(std::int64_t value) noexcept {
    varint((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
  }
  void bytes(ByteSpan bytes) noexcept {
    if (bytes.empty()) return;
    if (std::byte* const at = take(bytes.size())) std::memcpy(at, bytes.data(), bytes.size());
  }

  // A length in front of what it counts: begin_counted() leaves room for it, end_counted() writes
  // it and closes the gap.
  std::size_t begin_counted() noexcept {
    const std::size_t start = size_;
    take(kLongestVarint);
    return start;
  }
  void end_counted(std::size_t start) noexcept {
    if (!ok_) return;
    const std::size_t content = start + kLongestVarint;
    const std::size_t length = size_ - content;
    size_ = start;
    varint(length);
    std::memmove(buffer_.data() + size_, buffer_.data() + content, length);
    size_ += length;
  }

 private:
  std::byte* take(std::size_t count) noexcept {
    if (!ok_ || count > buffer_.size() - size_) {
      ok_ = false;
      return nullptr;
    }
    size_ += count;
    return buffer_.data() + size_ - count;
  }
  void fixed(std::uint64_t value, std::size_t count) noexcept {
    std::byte* const at = take(count);
    if (at == nullptr) return;
    for (std::size_t i = 0; i < count; ++i) at[i] = static_cast<std::byte>(value >> (8 * i));
  }

  std::span<std::byte> buffer_;
  std::size_t size_ = 0;
  bool ok_ = true;
};

// Reads what ByteWriter wrote. Reading past the end, or a varint over 64 bits, gives 0, and ok() is
// false from then on.
class ByteReader {
 public:
  explicit ByteReader(ByteSpan bytes) noexcept : rest_(bytes) {}

  bool ok() const noexcept { return ok_; }
  bool at_end() const noexcept { return rest_.empty(); }
  std::size_t left() const noexcept { return rest_.size(); }
  // True when all was read and nothing was missing.
  bool finished() const noexcept { return ok_ && rest_.empty(); }

  std::uint8_t u8() noexcept { return static_cast<std::uint8_t>(fixed(1)); }
  std::uint16_t u16() noexcept { return static_cast<std::uint16_t>(fixed(2)); }
  std::uint32_t u32() noexcept { return static_cast<std::uint32_t>(fixed(4)); }
  std::uint64_t u64() noexcept { return fixed(8); }
  std::int64_t i64() noexcept { return static_cast<std::int64_t>(fixed(8)); }
  double f64() noexcept { return std::bit_cast<double>(fixed(8)); }
  std::uint64_t varint() noexcept {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
      const std::uint64_t byte = u8();
      if (shift == 63 && byte > 1) break;
      value |= (byte & 0x7F) << shift;
      if ((byte & 0x80) == 0) return value;
    }
    fail();
    return 0;
  }
  // A varint of at most 32 bits; more fails.
  std::uint32_t varint32() noexcept {
    const std::uint64_t value = varint();
    if (value > 0xFFFFFFFFu) fail();
    return static_cast<std::uint32_t>(value);
  }
  std::int64_t zigzag() noexcept {
    const std::uint64_t value = varint();
    return static_cast<std::int64_t>((value >> 1) ^ (~(value & 1) + 1));
  }
  ByteSpan bytes(std::uint64_t count) noexcept {
    if (!ok_ || count > rest_.size()) {
      fail();
      return {};
    }
    const ByteSpan taken = rest_.first(static_cast<std::size_t>(count));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }
  void fail() noexcept {
    ok_ = false;
    rest_ = {};
  }

 private:
  std::uint64_t fixed(std::size_t count) noexcept {
    std::uint64_t value = 0;
    const ByteSpan taken = bytes(count);
    for (std::size_t i = 0; i < taken.size(); ++i) {
      value |= std::to_integer<std::uint64_t>(taken[i]) << (8 * i);
    }
    return value;
  }

  ByteSpan rest_;
  bool ok_ = true;
};

}  // namespace zonepack
