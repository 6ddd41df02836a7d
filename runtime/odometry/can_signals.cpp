// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/can_signals.hpp"

#include <bit>

namespace zonepack {
namespace {

using Status = SignalReading::Status;

bool finite(double value) noexcept { return value - value == 0; }

std::int64_t sign_extend(std::uint64_t bits, unsigned length) noexcept {
  const unsigned unused = 64 - length;
  return static_cast<std::int64_t>(bits << unused) >> unused;
}

double value_of(const CanSignal& signal, std::uint64_t bits, std::int64_t raw) noexcept {
  switch (signal.type) {
    case SignalType::kFloat:
      return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    case SignalType::kDouble:
      return std::bit_cast<double>(bits);
    case SignalType::kSigned:
      return static_cast<double>(raw);
    case SignalType::kUnsigned:
      break;
  }
  return static_cast<double>(bits);
}

}  // namespace

std::optional<std::uint8_t> bytes_needed(const SignalBits& bits) noexcept {
  if (bits.length < 1 || bits.length > 64 || bits.start > 511) return std::nullopt;
  const unsigned first =
      bits.order == ByteOrder::kLittle ? bits.start : bits.start / 8u * 8 + (7 - bits.start % 8u);
  const unsigned bytes = (first + bits.length + 7) / 8;
  if (bytes > 64) return std::nullopt;
  return static_cast<std::uint8_t>(bytes);
}

bool is_valid(const CanSignal& signal) noexcept {
  if (!bytes_needed(signal.bits)) return false;
  if (signal.multiplex && !bytes_needed(signal.multiplex->bits)) return false;
  if (signal.type == SignalType::kFloat && signal.bits.length != 32) return false;
  if (signal.type == SignalType::kDouble && signal.bits.length != 64) return false;
  if (signal.id > (signal.extended ? 0x1FFFFFFFu : 0x7FFu)) return false;
  return finite(signal.factor) && signal.factor != 0 && finite(signal.offset);
}

std::uint64_t extract_bits(const SignalBits& bits, const CanFrame& frame) noexcept {
  std::uint64_t value = 0;
  unsigned bit = bits.start;
  for (unsigned i = 0; i < bits.length; ++i) {
    const std::uint64_t one = (frame.data[bit / 8] >> (bit % 8)) & 1u;
    if (bits.order == ByteOrder::kLittle) {
      value |= one << i;
      ++bit;
    } else {
      value = value << 1 | one;
      bit = bit % 8 == 0 ? bit + 15 : bit - 1;
    }
  }
  return value;
}

SignalReading read_signal(const CanSignal& signal, const CanFrame& frame) noexcept {
  if (frame.error || frame.id != signal.id || frame.extended != signal.extended) return {};
  if (frame.rtr) return {Status::kRefused};
  if (signal.multiplex) {
    const SignalBits& selector = signal.multiplex->bits;
    if (frame.len < *bytes_needed(selector)) return {Status::kRefused};
    if (extract_bits(selector, frame) != signal.multiplex->value) return {};
  }
  if (frame.len < *bytes_needed(signal.bits)) return {Status::kRefused};
  const std::uint64_t bits = extract_bits(signal.bits, frame);
  const std::int64_t raw = signal.type == SignalType::kSigned
                               ? sign_extend(bits, signal.bits.length)
                               : static_cast<std::int64_t>(bits);
  const double value = value_of(signal, bits, raw) * signal.factor + signal.offset;
  if (!finite(value)) return {Status::kRefused};
  return {Status::kValue, value, raw};
}

std::int64_t wrapped_difference(std::int64_t newest, std::int64_t previous,
                                unsigned length) noexcept {
  return sign_extend(static_cast<std::uint64_t>(newest) - static_cast<std::uint64_t>(previous),
                     length);
}

}  // namespace zonepack
