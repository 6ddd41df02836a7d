// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/can_signals.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <initializer_list>
#include <random>

namespace zonepack {
namespace {

using Status = SignalReading::Status;

CanFrame frame(std::uint32_t id, std::initializer_list<int> bytes) {
  CanFrame made;
  made.id = id;
  for (const int byte : bytes) made.data[made.len++] = static_cast<std::uint8_t>(byte);
  return made;
}

CanSignal signal(std::uint16_t start, std::uint16_t length, ByteOrder order,
                 SignalType type = SignalType::kUnsigned, double factor = 1, double offset = 0) {
  CanSignal made;
  made.id = 0x311;
  made.bits = {start, length, order};
  made.type = type;
  made.factor = factor;
  made.offset = offset;
  return made;
}

// AgileX 0x311: two int32 of millimetres, big-endian. 0x40DB = 16603, 0xFFFFFFFE = -2.
TEST(CanSignals, ReadsTheOdometersOfAnAgileX) {
  const CanFrame f = frame(0x311, {0x00, 0x00, 0x40, 0xDB, 0xFF, 0xFF, 0xFF, 0xFE});
  const SignalReading left =
      read_signal(signal(7, 32, ByteOrder::kBig, SignalType::kSigned, 0.001), f);
  EXPECT_EQ(left.status, Status::kValue);
  EXPECT_EQ(left.raw, 16603);
  EXPECT_DOUBLE_EQ(left.value, 16.603);
  const SignalReading right =
      read_signal(signal(39, 32, ByteOrder::kBig, SignalType::kSigned, 0.001), f);
  EXPECT_EQ(right.raw, -2);
  EXPECT_DOUBLE_EQ(right.value, -0.002);
}

// Bytes A5 3C: bits 7..0 = 1010 0101, bits 15..8 = 0011 1100.
TEST(CanSignals, ReadsBitsAcrossBytesInBothOrders) {
  const CanFrame f = frame(0x311, {0xA5, 0x3C});
  // Little, start 4, length 8: high nibble of byte 0 (A) below the low nibble of byte 1 (C).
  EXPECT_EQ(read_signal(signal(4, 8, ByteOrder::kLittle), f).raw, 0xCA);
  // Big, start 3, length 8: low nibble of byte 0 (5) above the high nibble of byte 1 (3).
  EXPECT_EQ(read_signal(signal(3, 8, ByteOrder::kBig), f).raw, 0x53);
  EXPECT_EQ(read_signal(signal(0, 1, ByteOrder::kLittle), f).raw, 1);
  EXPECT_EQ(read_signal(signal(1, 1, ByteOrder::kBig), f).raw, 0);
  EXPECT_EQ(read_signal(signal(0, 16, ByteOrder::kLittle), f).raw, 0x3CA5);
  EXPECT_EQ(read_signal(signal(7, 16, ByteOrder::kBig), f).raw, 0xA53C);
}

TEST(CanSignals, ReadsFloatsAndScales) {
  // 1.5f = 0x3FC00000; 2.5 = 0x4004000000000000.
  const CanFrame one = frame(0x311, {0x00, 0x00, 0xC0, 0x3F});
  EXPECT_EQ(read_signal(signal(0, 32, ByteOrder::kLittle, SignalType::kFloat), one).value, 1.5);
  const CanFrame two = frame(0x311, {0x40, 0x04, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(read_signal(signal(7, 64, ByteOrder::kBig, SignalType::kDouble, 2, -1), two).value, 4);
  const CanFrame nan = frame(0x311, {0x00, 0x00, 0xC0, 0x7F});
  EXPECT_EQ(read_signal(signal(0, 32, ByteOrder::kLittle, SignalType::kFloat), nan).status,
            Status::kRefused);
}

TEST(CanSignals, RefusesWhatIsTooShortOrARemoteRequest) {
  const CanSignal s = signal(39, 32, ByteOrder::kBig);
  EXPECT_EQ(read_signal(s, frame(0x311, {0, 0, 0, 0, 0, 0, 0})).status, Status::kRefused);
  CanFrame f = frame(0x311, {0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(read_signal(s, f).status, Status::kValue);
  f.rtr = true;
  EXPECT_EQ(read_signal(s, f).status, Status::kRefused);
}

TEST(CanSignals, LooksAtItsOwnIdOnly) {
  const CanSignal s = signal(7, 8, ByteOrder::kBig);
  EXPECT_EQ(read_signal(s, frame(0x312, {1})).status, Status::kOther);
  CanFrame f = frame(0x311, {1});
  f.extended = true;
  EXPECT_EQ(read_signal(s, f).status, Status::kOther);
  f.extended = false;
  f.error = true;
  EXPECT_EQ(read_signal(s, f).status, Status::kOther);
}

TEST(CanSignals, IsThereOnlyWhenTheMultiplexerSelectsIt) {
  CanSignal s = signal(8, 8, ByteOrder::kLittle);
  ASSERT_TRUE(add_multiplexer(s, {0, 4, ByteOrder::kLittle}, {5, 5}));
  EXPECT_EQ(read_signal(s, frame(0x311, {0xF5, 7})).raw, 7);
  EXPECT_EQ(read_signal(s, frame(0x311, {0xF6, 7})).status, Status::kOther);
  EXPECT_EQ(read_signal(s, frame(0x311, {0xF5})).status, Status::kRefused);
  EXPECT_EQ(read_signal(s, frame(0x311, {})).status, Status::kRefused);
}

TEST(CanSignals, IsThereWhenEveryMultiplexerHasOneOfItsValues) {
  CanSignal s = signal(16, 8, ByteOrder::kLittle);
  EXPECT_FALSE(add_values(s, {1, 1}));
  ASSERT_TRUE(add_multiplexer(s, {0, 8, ByteOrder::kLittle}, {1, 1}));
  ASSERT_TRUE(add_multiplexer(s, {15, 8, ByteOrder::kBig}, {2, 3}));
  ASSERT_TRUE(add_values(s, {7, 7}));
  for (int inner = 0; inner < 10; ++inner) {
    const bool there = inner == 2 || inner == 3 || inner == 7;
    EXPECT_EQ(read_signal(s, frame(0x311, {1, inner, 9})).status,
              there ? Status::kValue : Status::kOther)
        << inner;
    EXPECT_EQ(read_signal(s, frame(0x311, {2, inner, 9})).status, Status::kOther);
  }
  EXPECT_TRUE(add_multiplexer(s, {0, 1, ByteOrder::kLittle}, {1, 1}));
  EXPECT_FALSE(add_multiplexer(s, {0, 1, ByteOrder::kLittle}, {1, 1}));
  EXPECT_TRUE(is_valid(s));
  for (int i = 1; i < 8; ++i) EXPECT_TRUE(add_values(s, {0, 0}));
  EXPECT_FALSE(add_values(s, {0, 0}));
  s.multiplexers[1].bits.length = 0;
  EXPECT_FALSE(is_valid(s));
}

TEST(CanSignals, KnowsTheBytesASignalNeeds) {
  EXPECT_EQ(bytes_needed({0, 8, ByteOrder::kLittle}), 1);
  EXPECT_EQ(bytes_needed({1, 8, ByteOrder::kLittle}), 2);
  EXPECT_EQ(bytes_needed({7, 32, ByteOrder::kBig}), 4);
  EXPECT_EQ(bytes_needed({6, 32, ByteOrder::kBig}), 5);
  EXPECT_EQ(bytes_needed({511, 1, ByteOrder::kLittle}), 64);
  EXPECT_EQ(bytes_needed({511, 2, ByteOrder::kLittle}), std::nullopt);
  EXPECT_EQ(bytes_needed({504, 2, ByteOrder::kBig}), std::nullopt);
  EXPECT_EQ(bytes_needed({512, 1, ByteOrder::kBig}), std::nullopt);
  EXPECT_EQ(bytes_needed({0, 0, ByteOrder::kBig}), std::nullopt);
  EXPECT_EQ(bytes_needed({0, 65, ByteOrder::kBig}), std::nullopt);
}

TEST(CanSignals, RecognisesValidSignals) {
  EXPECT_TRUE(is_valid(signal(0, 8, ByteOrder::kLittle)));
  EXPECT_FALSE(is_valid(signal(0, 16, ByteOrder::kLittle, SignalType::kFloat)));
  EXPECT_FALSE(is_valid(signal(0, 32, ByteOrder::kLittle, SignalType::kDouble)));
  EXPECT_FALSE(is_valid(signal(0, 8, ByteOrder::kLittle, SignalType::kSigned, 0)));
  CanSignal far = signal(0, 8, ByteOrder::kLittle);
  far.id = 0x800;
  EXPECT_FALSE(is_valid(far));
  far.extended = true;
  EXPECT_TRUE(is_valid(far));
}

TEST(CanSignals, DifferencesOfWrappingCountersGoTheShortWay) {
  EXPECT_EQ(wrapped_difference(5, 3, 32), 2);
  EXPECT_EQ(wrapped_difference(INT32_MIN, INT32_MAX, 32), 1);
  EXPECT_EQ(wrapped_difference(INT32_MAX, INT32_MIN, 32), -1);
  EXPECT_EQ(wrapped_difference(2, 65534, 16), 4);
  EXPECT_EQ(wrapped_difference(65534, 2, 16), -4);
  EXPECT_EQ(wrapped_difference(INT64_MIN, INT64_MAX, 64), 1);
  EXPECT_EQ(wrapped_difference(1, 0, 1), -1);  // one bit holds only 0 and -1
}

// Write a value bit by bit as DBC numbers them, read it back: all places, lengths and orders.
TEST(CanSignals, ReadBackWhatWasWrittenAnywhere) {
  std::mt19937 random(7);
  for (int round = 0; round < 20'000; ++round) {
    const SignalBits bits{static_cast<std::uint16_t>(random() % 512),
                          static_cast<std::uint16_t>(1 + random() % 64),
                          random() % 2 == 0 ? ByteOrder::kLittle : ByteOrder::kBig};
    if (!bytes_needed(bits)) continue;
    const std::uint64_t wide = std::uint64_t{random()} << 32 | random();
    const std::uint64_t value = bits.length == 64 ? wide : wide & ((1ull << bits.length) - 1);
    CanFrame f;
    f.len = *bytes_needed(bits);
    for (unsigned i = 0; i < bits.length; ++i) {
      // The i-th bit from the top (big) counts bytes up and bits down, from the start's place.
      const unsigned place = bits.start / 8u * 8 + (7 - bits.start % 8u) + i;
      const unsigned bit =
          bits.order == ByteOrder::kLittle ? bits.start + i : place / 8 * 8 + (7 - place % 8);
      const unsigned shift = bits.order == ByteOrder::kLittle ? i : bits.length - 1u - i;
      if ((value >> shift & 1) != 0) {
        f.data[bit / 8] = static_cast<std::uint8_t>(f.data[bit / 8] | 1u << bit % 8);
      }
    }
    ASSERT_EQ(extract_bits(bits, f), value) << bits.start << "|" << bits.length;
  }
}

}  // namespace
}  // namespace zonepack
