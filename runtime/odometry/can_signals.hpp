// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "platform/can_bus.hpp"

// Numbers out of CAN frames, as a DBC file describes them, without its text.
// Real-time: no allocation, at most 64 steps per value.
namespace zonepack {

enum class ByteOrder : std::uint8_t { kLittle /* Intel */, kBig /* Motorola */ };
enum class SignalType : std::uint8_t { kUnsigned, kSigned, kFloat, kDouble };

// Bits of a frame. Bit n is bit n % 8 of byte n / 8. Little: start is the least significant bit and
// the value grows upwards. Big: start is the most significant bit and the value continues with the
// lower bits of the byte, then bit 7 of the next (DBC's sawtooth numbering): an int32 that fills
// bytes 0 to 3 starts at 7.
struct SignalBits {
  std::uint16_t start = 0;
  std::uint16_t length = 0;  // 1 to 64
  ByteOrder order = ByteOrder::kLittle;
  friend bool operator==(const SignalBits&, const SignalBits&) = default;
};

// Bytes a frame must have to hold these bits, at most 64; nullopt when no frame can.
std::optional<std::uint8_t> bytes_needed(const SignalBits& bits) noexcept;

struct CanSignal {
  // Present only in frames in which other bits have one value.
  struct Multiplex {
    SignalBits bits;
    std::uint64_t value = 0;
    friend bool operator==(const Multiplex&, const Multiplex&) = default;
  };
  std::uint32_t id = 0;
  bool extended = false;
  SignalBits bits;
  SignalType type = SignalType::kUnsigned;
  double factor = 1;  // value = raw * factor + offset
  double offset = 0;
  std::optional<Multiplex> multiplex;
  friend bool operator==(const CanSignal&, const CanSignal&) = default;
};

// Length 1 to 64 (32 of a float, 64 of a double) inside 64 bytes, id in its range, finite factor
// other than zero, finite offset.
bool is_valid(const CanSignal& signal) noexcept;

struct SignalReading {
  enum class Status : std::uint8_t {
    kOther,  // another id, an error frame, or the multiplexer selects another signal
    kValue,
    kRefused,  // the right id, but too short, a remote request, or not a finite number
  };
  Status status = Status::kOther;
  double value = 0;      // physical
  std::int64_t raw = 0;  // integers: sign-extended, unsigned 64-bit values as their bit pattern
};

// The signal must be valid.
SignalReading read_signal(const CanSignal& signal, const CanFrame& frame) noexcept;

// Raw bits, right-aligned; the frame must be long enough.
std::uint64_t extract_bits(const SignalBits& bits, const CanFrame& frame) noexcept;

// newest - previous of a counter of `length` bits that wraps, taken the short way round: in
// [-2^(length-1), 2^(length-1)).
std::int64_t wrapped_difference(std::int64_t newest, std::int64_t previous,
                                unsigned length) noexcept;

}  // namespace zonepack
