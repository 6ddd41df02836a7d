// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/can_signals.hpp"

#include <bit>

namespace zonepack {
namespace {

using SignalStatus = SignalReading::Status;

bool is_finite(double value) noexcept { return value - value == 0; }

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

bool selects(const CanSignal::Multiplexer& multiplexer, std::uint64_t value) noexcept {
  for (std::size_t i = 0; i < multiplexer.ranges; ++i) {
    const CanSignal::Values& values = multiplexer.values[i];
    if (values.least <= value && value <= values.most) return true;
  }
  return false;
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
  if (signal.levels > CanSignal::kMostLevels) return false;
  for (std::size_t level = 0; level < signal.levels; ++level) {
    const CanSignal::Multiplexer& multiplexer = signal.multiplexers[level];
    if (!bytes_needed(multiplexer.bits)) return false;
    if (multiplexer.ranges < 1 || multiplexer.ranges > multiplexer.values.size()) return false;
  }
  if (signal.type == SignalType::kFloat && signal.bits.length != 32) return false;
  if (signal.type == SignalType::kDouble && signal.bits.length != 64) return false;
  if (signal.id > (signal.extended ? 0x1FFFFFFFu : 0x7FFu)) return false;
  return is_finite(signal.factor) && signal.factor != 0 && is_finite(signal.offset);
}

bool add_multiplexer(CanSignal& signal, const SignalBits& bits, CanSignal::Values values) noexcept {
  if (signal.levels >= CanSignal::kMostLevels) return false;
  signal.multiplexers[signal.levels++] = {bits, {values}, 1};
  return true;
}

bool add_values(CanSignal& signal, CanSignal::Values values) noexcept {
  if (signal.levels == 0) return false;
  CanSignal::Multiplexer& innermost = signal.multiplexers[signal.levels - 1u];
  if (innermost.ranges >= innermost.values.size()) return false;
  innermost.values[innermost.ranges++] = values;
  return true;
}

std::uint64_t extract_bits(const SignalBits& bits, const CanFrame& frame) noexcept {
  const bool little = bits.order == ByteOrder::kLittle;
  const unsigned skipped = little ? bits.start % 8u : 7 - bits.start % 8u;  // of the first byte
  const unsigned used = skipped + bits.length;
  const std::uint8_t* const data = &frame.data[bits.start / 8u];
  const unsigned whole = used > 64 ? 8 : (used + 7) / 8;
  std::uint64_t value = 0;
  if (little) {
    for (unsigned i = 0; i < whole; ++i) value |= std::uint64_t{data[i]} << (8 * i);
    value >>= skipped;
    if (used > 64) value |= std::uint64_t{data[8]} << (64 - skipped);
  } else {
    for (unsigned i = 0; i < whole; ++i) value = value << 8 | data[i];
    if (used > 64) {
      value = value << (used - 64) | data[8] >> (72 - used);
    } else {
      value >>= 8 * whole - used;
    }
  }
  return value & (~std::uint64_t{0} >> (64 - bits.length));
}

SignalReading read_signal(const CanSignal& signal, const CanFrame& frame) noexcept {
  if (frame.error || frame.id != signal.id || frame.extended != signal.extended) return {};
  if (frame.rtr) return {SignalStatus::kRefused};
  for (std::size_t level = 0; level < signal.levels; ++level) {
    const CanSignal::Multiplexer& multiplexer = signal.multiplexers[level];
    if (frame.len < *bytes_needed(multiplexer.bits)) return {SignalStatus::kRefused};
    if (!selects(multiplexer, extract_bits(multiplexer.bits, frame))) return {};
  }
  if (frame.len < *bytes_needed(signal.bits)) return {SignalStatus::kRefused};
  const std::uint64_t bits = extract_bits(signal.bits, frame);
  const std::int64_t raw = signal.type == SignalType::kSigned
                               ? sign_extend(bits, signal.bits.length)
                               : static_cast<std::int64_t>(bits);
  const double value = value_of(signal, bits, raw) * signal.factor + signal.offset;
  if (!is_finite(value)) return {SignalStatus::kRefused};
  return {SignalStatus::kValue, value, raw};
}

std::int64_t wrapped_difference(std::int64_t newest, std::int64_t previous,
                                unsigned length) noexcept {
  return sign_extend(static_cast<std::uint64_t>(newest) - static_cast<std::uint64_t>(previous),
                     length);
}

}  // namespace zonepack
