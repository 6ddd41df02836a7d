// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/input_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "runtime/recording/byte_ring.hpp"
#include "runtime/recording/cycle_block.hpp"
#include "tests/support/allocation_count/allocation_count.hpp"

namespace zonepack {
namespace {

CanFrame frame(std::uint32_t id, std::int64_t stamp_ns) {
  CanFrame made;
  made.id = id;
  made.stamp_ns = stamp_ns;
  made.len = 8;
  for (std::uint8_t i = 0; i < 8; ++i) made.data[i] = i;
  return made;
}

// One of everything, at the ends of its range.
struct Everything {
  Everything() {
    frames = {frame(0x311, 1000), frame(0x221, 500), frame(0x1FFFFFFF, -5),
              frame(1, std::numeric_limits<std::int64_t>::max()),
              frame(2, std::numeric_limits<std::int64_t>::min())};
    frames[2].extended = frames[2].fd = true;
    frames[2].flags = 3;
    frames[2].len = 64;
    frames[2].data.fill(0xAB);
    frames[3].rtr = true;
    frames[3].data.fill(0);
    frames[4].error = true;
    frames[4].len = 0;
    frames[4].data.fill(0);
    corrections = {{.stamp_ns = 990,
                    .received_ns = 1000,
                    .T_map_base = {1.5, -2.25, 3.0},
                    .sigma_x_m = 0.03,
                    .sigma_y_m = 0.04,
                    .sigma_yaw_rad = 0.01},
                   {.stamp_ns = -7,
                    .received_ns = 2,
                    .T_map_base = {std::numeric_limits<double>::quiet_NaN(), 0, 0},
                    .sigma_x_m = -0.0,
                    .sigma_y_m = 0,
                    .sigma_yaw_rad = 1e308}};
    loads = {
        {.zone = 3, .generation = 7, .error = {}, .slots = {.head = 5, .tail = 9, .count = 12}},
        {.zone = kNoZone,
         .generation = 0xFFFFFFFF,
         .error = {ErrorCode::kCancelled, std::numeric_limits<std::int64_t>::min()},
         .slots = {}}};
    commands.resize(2);
    commands[0].kind = Command::Kind::kRelease;
    commands[0].id = 0xFFFFFFFFFFFFFFFF;
    commands[0].lease = {.zone = 4, .generation = 5, .epoch = 6};
    commands[1].kind = Command::Kind::kRouteHint;
    commands[1].route_length = Command::kMostRoute;
    commands[1].route.fill(9);
    edges = {{.stamp_ns = 990, .line = LineEdge::kDock, .active = true},
             {.stamp_ns = std::numeric_limits<std::int64_t>::min(), .line = 0xFFFFFFFF}};
  }
  CycleInput input() const {
    return {.now_ns = 1000,
            .frames = frames,
            .corrections = corrections,
            .loads = loads,
            .commands = commands,
            .edges = edges};
  }

  std::vector<CanFrame> frames;
  std::vector<PoseCorrection> corrections;
  std::vector<LoadResult> loads;
  std::vector<Command> commands;
  std::vector<LineEdge> edges;
};

std::vector<std::byte> recorded(const CycleInput& input) {
  std::vector<std::byte> bytes(kMostCycleBytes);
  ByteWriter out(bytes);
  write_records(input, out);
  EXPECT_TRUE(out.ok());
  bytes.resize(out.size());
  return bytes;
}

// Recordings of fixes that say nothing are the same as before there were views.
TEST(InputRecord, HoldsHowFarALocalizerSeesWhereAFixSaysIt) {
  Everything all;
  const std::size_t without = recorded(all.input()).size();
  all.corrections[1].view_m = 8.5;
  const std::vector<std::byte> bytes = recorded(all.input());
  EXPECT_EQ(bytes.size(), without + 2 + 2 * 8);  // kind, count, two f64
  RecordedInput back;
  back.now_ns = 1000;
  ASSERT_TRUE(read_records(bytes, back).ok());
  EXPECT_EQ(back.corrections[0].view_m, 0);
  EXPECT_EQ(back.corrections[1].view_m, 8.5);
}

TEST(InputRecord, GivesBackEveryInputAsItWas) {
  const Everything all;
  const std::vector<std::byte> bytes = recorded(all.input());
  RecordedInput back;
  back.now_ns = 1000;
  ASSERT_TRUE(read_records(bytes, back).ok());
  ASSERT_EQ(back.frames.size(), all.frames.size());
  for (std::size_t i = 0; i < back.frames.size(); ++i) {
    const CanFrame &a = back.frames[i], &b = all.frames[i];
    EXPECT_EQ(a.stamp_ns, b.stamp_ns);
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.extended, b.extended);
    EXPECT_EQ(a.fd, b.fd);
    EXPECT_EQ(a.rtr, b.rtr);
    EXPECT_EQ(a.error, b.error);
    EXPECT_EQ(a.flags, b.flags);
    EXPECT_EQ(a.len, b.len);
    EXPECT_EQ(a.data, b.data);
  }
  ASSERT_EQ(back.corrections.size(), 2u);
  EXPECT_EQ(back.corrections[0].T_map_base, all.corrections[0].T_map_base);
  EXPECT_EQ(back.corrections[1].stamp_ns, -7);
  EXPECT_TRUE(std::isnan(back.corrections[1].T_map_base.x_m));
  EXPECT_TRUE(std::signbit(back.corrections[1].sigma_x_m));
  ASSERT_EQ(back.loads.size(), 2u);
  EXPECT_EQ(back.loads[0].slots.count, 12u);
  EXPECT_EQ(back.loads[1].error, all.loads[1].error);
  EXPECT_EQ(back.loads[1].zone, kNoZone);
  ASSERT_EQ(back.commands.size(), 2u);
  EXPECT_EQ(back.commands[0].id, all.commands[0].id);
  EXPECT_EQ(back.commands[0].lease.epoch, 6u);
  EXPECT_EQ(back.commands[1].route, all.commands[1].route);
  ASSERT_EQ(back.edges.size(), 2u);
  EXPECT_EQ(back.edges[0].stamp_ns, 990);
  EXPECT_TRUE(back.edges[0].active);
  EXPECT_EQ(back.edges[1].line, 0xFFFFFFFF);
  EXPECT_FALSE(back.edges[1].active);
  // Written again, the same bytes.
  EXPECT_EQ(recorded(back.view()), bytes);
}

TEST(InputRecord, TakesNoMemoryToWriteAndReportsWhatDoesNotFit) {
  const Everything all;
  std::vector<std::byte> bytes(record_room(64));
  ByteWriter out(bytes);
  ByteWriter small(std::span<std::byte>(bytes).first(100));
  const testing_support::AllocationCount allocated;
  write_records(all.input(), out);
  write_records(all.input(), small);
  EXPECT_EQ(allocated.count(), 0u);
  EXPECT_TRUE(out.ok());
  EXPECT_FALSE(small.ok());
}

TEST(InputRecord, RefusesAnInputItDoesNotKnowAndPassesOverNotes) {
  const std::byte unknown[] = {std::byte{9}, std::byte{0}};
  const std::byte note[] = {std::byte{200}, std::byte{1}, std::byte{7}};
  RecordedInput into;
  EXPECT_EQ(read_records(unknown, into).error(), (Error{ErrorCode::kBadVersion, 9}));
  EXPECT_TRUE(read_records(note, into).ok());
  EXPECT_FALSE(read_records(std::span(note).first(2), into).ok());
}

TEST(CycleBlock, StoresACycleWithoutInputInOneByte) {
  CycleBlockWriter block(10'000'000);
  TappedCycle cycle;
  cycle.head = {.cycle = 7, .now_ns = 500, .clock_offset_ns = 40, .T_map_base = {}, .map = 0};
  block.add(cycle);
  const std::size_t first = block.content().size();
  EXPECT_EQ(first, 33u);  // 4 numbers of 8 bytes, and the cycle's flags
  for (std::uint64_t i = 0; i < 99; ++i) {
    ++cycle.head.cycle;
    cycle.head.now_ns += 10'000'000;
    block.add(cycle);
  }
  EXPECT_EQ(block.content().size(), first + 99);
  // 5000 ns early: a byte of flags and 9999 as a varint of two.
  ++cycle.head.cycle;
  cycle.head.now_ns += 10'000'000 - 5000;
  block.add(cycle);
  EXPECT_EQ(block.content().size(), first + 99 + 3);

  CycleBlockReader reader(block.content());
  EXPECT_EQ(reader.next_cycle(), 7u);
  RecordedInput input;
  for (std::int64_t i = 0; i < 100; ++i) {
    ASSERT_TRUE(reader.next(input).ok());
    EXPECT_EQ(input.now_ns, 500 + i * 10'000'000);
  }
  ASSERT_TRUE(reader.next(input).ok());
  EXPECT_EQ(input.now_ns, 500 + 100 * std::int64_t{10'000'000} - 5000);
  EXPECT_EQ(reader.clock_offset_ns(), 40);
  EXPECT_TRUE(reader.at_end());
}

TEST(ByteRing, KeepsMessagesWholeAndInOrderAcrossItsEndAndRefusesWhatDoesNotFit) {
  ByteRing ring(128);
  std::vector<std::byte> message(40), got;
  unsigned pushed = 0, popped = 0;
  for (int round = 0; round < 1000; ++round) {
    const std::size_t size = 1 + static_cast<std::size_t>(round * 7 % 39);
    for (std::size_t i = 0; i < size; ++i) message[i] = static_cast<std::byte>(pushed + i);
    const auto all = std::span(message).first(size);
    if (ring.push(all.first(size / 2), all.subspan(size / 2))) {
      ++pushed;
      if (round % 3 != 0) continue;
    }
    got.resize(ring.next_size());
    ring.pop(got);
    for (std::size_t i = 0; i < got.size(); ++i) {
      ASSERT_EQ(got[i], static_cast<std::byte>(popped + i));
    }
    ++popped;
  }
  EXPECT_GT(popped, 400u);
  EXPECT_FALSE(ring.push(std::vector<std::byte>(125), {}));  // 4 more for its length
}

TEST(InputRecord, CarriesTheMapOnOfferOrWhyThereIsNone) {
  for (const MapOffer offer : {MapOffer{.map = 7}, MapOffer{.fault = ErrorCode::kTruncated}}) {
    CycleInput input;
    input.offer = offer;
    std::vector<std::byte> bytes(64);
    ByteWriter out(bytes);
    write_records(input, out);
    RecordedInput back;
    back.offer.map = 99;
    ASSERT_TRUE(read_records(out.written(), back));
    EXPECT_EQ(back.offer.map, offer.map);
    EXPECT_EQ(back.offer.fault, offer.fault);
    EXPECT_EQ(read_records(out.written().first(out.size() - 1), back).error().code,
              ErrorCode::kBadStructure);
  }
}

TEST(InputRecord, SaysWhetherZonesAreKeptThroughAChangeOfMap) {
  for (const bool keeps : {false, true}) {
    CycleInput input;
    input.offer = {.map = 2, .keeps = keeps};
    std::vector<std::byte> bytes(64);
    ByteWriter out(bytes);
    write_records(input, out);
    RecordedInput back;
    ASSERT_TRUE(read_records(out.written(), back));
    EXPECT_EQ(back.offer.keeps, keeps);
    EXPECT_EQ(back.offer.map, 2u);
  }
}

}  // namespace
}  // namespace zonepack
