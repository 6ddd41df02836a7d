// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "platform/can/can_bus.hpp"

// Numbers out of CAN frames, as a DBC file describes them, without its text.
// Real-time: no allocation; a value takes at most 9 bytes, one after the other, and so does each of
// its multiplexers, at most 3.
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
  struct Values {
    std::uint64_t least = 0;
    std::uint64_t most = 0;
    friend bool operator==(const Values&, const Values&) = default;
  };
  // Present only in frames in which other bits, read unsigned, have one of some values.
  struct Multiplexer {
    static constexpr std::size_t kMostRanges = 8;
    SignalBits bits;
    std::array<Values, kMostRanges> values{};
    std::uint8_t ranges = 0;  // how many of values count
    friend bool operator==(const Multiplexer&, const Multiplexer&) = default;
  };
  static constexpr std::size_t kMostLevels = 3;
  std::uint32_t id = 0;
  bool extended = false;
  SignalBits bits;
  SignalType type = SignalType::kUnsigned;
  double factor = 1;  // value = raw * factor + offset
  double offset = 0;
  std::array<Multiplexer, kMostLevels> multiplexers{};  // all must select it, outermost first
  std::uint8_t levels = 0;                              // how many of multiplexers count
  friend bool operator==(const CanSignal&, const CanSignal&) = default;
};

// Adds a multiplexer inside the existing ones, with one range of values. False: no room.
bool add_multiplexer(CanSignal& signal, const SignalBits& bits, CanSignal::Values values) noexcept;
// Adds a range to the innermost one. False: no room, or no multiplexer.
bool add_values(CanSignal& signal, CanSignal::Values values) noexcept;

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

// newest - previous of a counter of `length` bits that wraps, taken the shorter way around: in
// [-2^(length-1), 2^(length-1)).
std::int64_t wrapped_difference(std::int64_t newest, std::int64_t previous,
                                unsigned length) noexcept;

}  // namespace zonepack
