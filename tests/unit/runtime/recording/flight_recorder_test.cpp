// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/flight_recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "runtime/recording/flight_names.hpp"
#include "tests/unit/runtime/recording/recorded_drive.hpp"

namespace zonepack {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing_support::text_of;

class FlightRecorderTest : public testing_support::ReplaysADrive {
 protected:
  // A block that hardly compresses, so that few fill the ring.
  void append(FlightRecorder& flight, std::uint64_t cycle) {
    if (flight.wants_segment()) {
      Checkpoint checkpoint;
      checkpoint.cycle = cycle;
      checkpoint.map = map;
      flight.begin_segment(checkpoint, false);
    }
    CycleBlockWriter block(10);
    std::mt19937_64 random(cycle);
    std::vector<std::byte> records(60'000);
    ByteWriter out(records);
    out.u8(kFirstNoteKind);
    out.varint(records.size() - 4);
    while (out.size() < records.size()) out.u8(static_cast<std::uint8_t>(random()));
    TappedCycle tapped;
    tapped.head.cycle = cycle;
    tapped.head.now_ns = static_cast<std::int64_t>(cycle) * 10;
    tapped.records = records;
    block.add(tapped);
    std::vector<std::byte> sealed;
    seal_block(BlockKind::kCycles, block.content(), sealed);
    flight.append(sealed, cycle + 1);
  }

  std::uint32_t map = 1;  // in use
};

TEST_F(FlightRecorderTest, KeepsAMapForAsLongAsACycleNeedsIt) {
  auto flight =
      FlightRecorder::open(path("flight"), true, FlightRecorder::kLeastBytes, drive.preface());
  ASSERT_TRUE(flight.ok());
  std::uint64_t cycle = 0;
  const auto pass = [&](int cycles) {
    while (cycles-- > 0) append(**flight, cycle++);
  };
  const auto offer = [&](std::uint32_t number) {
    pass(1);
    (*flight)->add_map(number, write_map({number, "maps", {std::byte{1}}}), cycle);
    pass(1);
  };
  const auto has = [&](std::uint32_t number) {
    EXPECT_TRUE((*flight)->dump(path("dump.zpr")));
    for (const std::string& recording : {path("dump.zpr"), path("flight")}) {
      const auto reader = RecordingReader::open(recording);
      EXPECT_TRUE(reader.ok()) << reader.error().message;
      if (!reader || reader->map(number) == nullptr) return false;
    }
    return true;
  };
  offer(2);  // refused, for example
  offer(3);
  map = 3;  // in use from here on
  EXPECT_TRUE(has(2) && has(3));
  pass(100);  // all segments begin after both offers
  EXPECT_FALSE(has(2));
  EXPECT_TRUE(has(3));
  map = 1;
  pass(100);
  EXPECT_FALSE(has(3));
}

TEST_F(FlightRecorderTest, DumpsAWholeRunThatReplaysToTheSameEvents) {
  for (const bool named : {true, false}) {
    auto flight = FlightRecorder::open(path("."), named, 64 * kMiB, drive.preface());
    ASSERT_TRUE(flight.ok());
    drive.drive(5, path("live.jsonl"), nullptr, flight->get());
    const auto dumped = (*flight)->dump(path("dump.zpr"));
    ASSERT_TRUE(dumped.ok());
    EXPECT_EQ(dumped->first_cycle, 0u);
    EXPECT_EQ(dumped->bytes, fs::file_size(path("dump.zpr")));
    const auto result = replay(path("dump.zpr"));
    ASSERT_TRUE(result) << fault;
    EXPECT_TRUE(result->exact && result->complete);
    EXPECT_EQ(result->next_cycle, dumped->next_cycle);
    EXPECT_EQ(text_of(path("again.jsonl")), text_of(path("live.jsonl")));
    EXPECT_THAT(note, HasSubstr("when it was saved"));
  }
}

TEST_F(FlightRecorderTest, DumpsARunInProgressUpToThatMoment) {
  auto flight = FlightRecorder::open(path("flight"), true, 64 * kMiB, drive.preface());
  std::uint64_t saved_at = 0;
  drive.drive(6, path("live.jsonl"), nullptr, flight->get(),
              [&](std::uint64_t cycle, InputWriter& writer) {
                if (cycle % 50 == 0) writer.flush();
                if (cycle == 5000) saved_at = (*flight)->dump(path("dump.zpr"))->next_cycle;
              });
  EXPECT_EQ(saved_at, 5001u);
  const auto result = replay(path("dump.zpr"));
  ASSERT_TRUE(result) << fault;
  EXPECT_EQ(result->next_cycle, saved_at);
  // The folder itself is a recording, also of a process that was killed.
  const auto all = replay(path("flight"));
  ASSERT_TRUE(all) << fault;
  EXPECT_GT(all->next_cycle, 10'900u);
  EXPECT_THAT(note, HasSubstr("without an end mark"));
}

TEST_F(FlightRecorderTest, KeepsItsBytesAndForgetsTheOldest) {
  const ByteCount limit = 4 * kMiB;
  auto flight = FlightRecorder::open(path("flight"), true, limit, drive.preface());
  for (std::uint64_t cycle = 0; cycle < 300; ++cycle) {
    append(**flight, cycle);
    // The last block of a segment may exceed it: 60 kB in each of 8, and the preface.
    EXPECT_LE((*flight)->kept_bytes(), limit + 8 * 65'000 + 10'000);
  }
  // 300 blocks of 60 kB are 18 MB; of 4 MiB at least 7 of 8 segments are full.
  EXPECT_GE((*flight)->kept_bytes(), limit * 7 / 8);
  EXPECT_EQ(flight_files(path("flight")).size(), 1 + FlightRecorder::kSegments);
  const auto dumped = (*flight)->dump(path("dump.zpr"));
  ASSERT_TRUE(dumped.ok());
  EXPECT_GT(dumped->first_cycle, 200u);
  EXPECT_EQ(dumped->next_cycle, 300u);
  auto reader = RecordingReader::open(path("dump.zpr"));
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  ASSERT_TRUE(reader->checkpoint());
  EXPECT_EQ(reader->checkpoint()->cycle, dumped->first_cycle);
  while (reader->next() != nullptr) {
  }
  EXPECT_TRUE(reader->complete());
  EXPECT_EQ(reader->cycles_read(), 300u);
}

// Reloads without end, each offering a map of 300 kB, most of them refused: descriptors, files and
// bytes stay within their bounds, and what is kept can be replayed.
TEST_F(FlightRecorderTest, BoundsTheMapsOfReloads) {
  const auto descriptors = [] {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
  };
  const ByteCount limit = 4 * kMiB;
  auto flight = FlightRecorder::open(path("flight"), true, limit, drive.preface());
  ASSERT_TRUE(flight.ok());
  const auto before = descriptors();
  std::mt19937_64 random(1);
  std::vector<std::byte> manifest(300'000);
  for (std::byte& byte : manifest) byte = static_cast<std::byte>(random());
  std::uint64_t cycle = 0;
  for (std::uint32_t number = 2; number < 60; ++number) {
    append(**flight, cycle++);
    (*flight)->add_map(number, write_map({number, "maps", manifest}), cycle);
    append(**flight, cycle++);
    if (number % 10 == 0) map = number;
    EXPECT_LE((*flight)->kept_bytes(), limit + 8 * 65'000 + 310'000);
    // Preface, segments, maps, and the map that makes the next segment begin.
    const std::size_t most = 1 + FlightRecorder::kSegments + FlightRecorder::kMostMaps + 1;
    EXPECT_LE(flight_files(path("flight")).size(), most);
    EXPECT_LE(static_cast<std::size_t>(descriptors() - before), most);
  }
  ASSERT_TRUE((*flight)->dump(path("dump.zpr")).ok());
  auto reader = RecordingReader::open(path("dump.zpr"));
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  EXPECT_NE(reader->map(50), nullptr) << "in use";
  EXPECT_NE(reader->map(59), nullptr) << "offered last";
}

// A link or a pipe in the place of one of its files is replaced; a link's target stays as it was.
TEST_F(FlightRecorderTest, FollowsNoLinkInItsFolder) {
  fs::create_directories(path("flight"));
  std::ofstream(path("target")) << "precious";
  fs::create_symlink(path("target"), path("flight/segment-0000000000"));
  auto flight = FlightRecorder::open(path("flight"), true, kMiB, drive.preface());
  ASSERT_TRUE(flight.ok());
  append(**flight, 0);
  EXPECT_EQ(text_of(path("target")), "precious");
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(path("flight/segment-0000000000"))));
}

TEST_F(FlightRecorderTest, KeepsTheFilesOfTheRunBefore) {
  auto first = FlightRecorder::open(path("flight"), true, kMiB, drive.preface());
  append(**first, 0);
  auto second = FlightRecorder::open(path("flight"), true, kMiB, drive.preface());
  ASSERT_TRUE(second.ok());
  EXPECT_EQ((*second)->dump(path("dump.zpr")).error().code, ErrorCode::kNotFound);
  auto reader = RecordingReader::open(path("flight-previous"));
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  EXPECT_NE(reader->next(), nullptr);
}

// The beginning is gone: from the checkpoint the run continues as from a guess.
TEST_F(FlightRecorderTest, ContinuesFromACheckpointAsFromAGuess) {
  auto flight = FlightRecorder::open(path("flight"), true, 64 * kMiB, drive.preface());
  bool lost = false;
  drive.drive(7, path("live.jsonl"), nullptr, flight->get(),
              [&](std::uint64_t cycle, InputWriter& writer) {
                lost = cycle >= 500 && cycle < 7000;  // the tap overflows
                if (!lost) writer.flush();
              });
  const auto dumped = (*flight)->dump(path("dump.zpr"));
  ASSERT_TRUE(dumped.ok());
  EXPECT_EQ(dumped->first_cycle, 7001u);  // 7000 found the tap still full
  auto reader = RecordingReader::open(path("dump.zpr"));
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  ASSERT_TRUE(reader->checkpoint());
  EXPECT_TRUE(reader->checkpoint()->has_pose);
  EXPECT_FALSE(reader->checkpoint()->resident.empty());
  const auto result = replay(path("dump.zpr"));
  ASSERT_TRUE(result) << fault;
  EXPECT_FALSE(result->exact);
  EXPECT_EQ(result->replay.summary.budget_violations, 0u);
  // It ends where the run ended: the same zone, the same millimetres, for fixes have come.
  const std::string live = text_of(path("live.jsonl")), again = text_of(path("again.jsonl"));
  const auto end_of = [](const std::string& events) {
    const std::string line = events.substr(events.rfind("{\"cycle\""));
    return line.substr(0, line.find("\"charged")) + line.substr(line.find("\"x_mm\"") + 0, 12);
  };
  EXPECT_EQ(end_of(again), end_of(live));
}

// The recording begins while the robot is lost and its localizer waits for a zone, which the replay
// goes on to have loaded; that it is found is an event of the same cycle as in the run.
TEST_F(FlightRecorderTest, ContinuesARunThatWasLostAtItsCheckpoint) {
  drive.lost = {.from = 6000, .until = 8000, .sought = 9};
  auto flight = FlightRecorder::open(path("flight"), true, 64 * kMiB, drive.preface());
  drive.drive(7, path("live.jsonl"), nullptr, flight->get(),
              [&](std::uint64_t cycle, InputWriter& writer) {
                if (cycle < 500 || cycle >= 6500) writer.flush();
              });
  ASSERT_TRUE((*flight)->dump(path("dump.zpr")).ok());
  const auto reader = RecordingReader::open(path("dump.zpr"));
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  ASSERT_TRUE(reader->checkpoint());
  EXPECT_TRUE(reader->checkpoint()->lost);
  EXPECT_EQ(reader->checkpoint()->sought, 9u);
  EXPECT_FALSE(reader->checkpoint()->has_pose);
  ASSERT_TRUE(replay(path("dump.zpr"))) << fault;
  const auto of_the_search = [&](const std::string& events) {
    std::istringstream lines(text_of(path(events)));
    std::string line, chosen;
    while (std::getline(lines, line)) {
      if (std::stoull(line.substr(line.find(':') + 1)) <= 6501) continue;
      if (line.find("\"pose_") != std::string::npos ||
          line.find("\"zone_unwanted\",\"zone\":\"L2\"") != std::string::npos) {
        chosen += line.substr(0, line.find("signatures\"")) + '\n';
      }
    }
    return chosen;
  };
  EXPECT_EQ(of_the_search("again.jsonl"), of_the_search("live.jsonl"));
  EXPECT_THAT(of_the_search("live.jsonl"), HasSubstr("pose_found"));
  EXPECT_THAT(of_the_search("live.jsonl"), HasSubstr("zone_unwanted"));  // L2 was waited for
}

TEST_F(FlightRecorderTest, CountsWhatItCannotWriteAndContinues) {
  auto flight = FlightRecorder::open(path("flight"), true, kMiB, drive.preface());
  append(**flight, 0);
  fs::remove_all(path("flight"));
  for (std::uint64_t cycle = 1; cycle < 100; ++cycle) append(**flight, cycle);
  EXPECT_GT((*flight)->failures(), 0u);
  EXPECT_EQ((*flight)->last_error().detail, ENOENT);
  fs::create_directories(path("flight"));
  for (std::uint64_t cycle = 100; cycle < 110; ++cycle) append(**flight, cycle);
  const auto dumped = (*flight)->dump(path("dump.zpr"));
  ASSERT_TRUE(dumped.ok());
  EXPECT_EQ(dumped->first_cycle, 100u);
  EXPECT_EQ(dumped->next_cycle, 110u);
}

}  // namespace
}  // namespace zonepack
