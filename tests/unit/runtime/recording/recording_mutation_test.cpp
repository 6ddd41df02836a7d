// SPDX-License-Identifier: Apache-2.0
// Made-up recordings: whatever the bytes are, reading and replaying them ends in order, with cycles
// that follow each other.
#include <gtest/gtest.h>

#include <numeric>

#include "tests/fuzz/mutator.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/runtime/recording/recorded_drive.hpp"

namespace zonepack {
namespace {

using Bytes = std::vector<std::byte>;

class RecordingMutation : public testing::Test {
 protected:
  RecordingMutation() {
    auto file = RecordingFile::create(path("whole.zpr"), drive.preface());
    drive.drive(1, path("live.jsonl"), file->get(), nullptr);
  }

  std::string path(const std::string& name) const { return folder / name; }

  // The records of the first cycles, as one content.
  Bytes first_cycles(std::uint64_t count) {
    auto reader = RecordingReader::open(path("whole.zpr"));
    CycleBlockWriter block(drive.preface().terms.period_ns);
    Bytes records(kMostCycleBytes);
    while (reader->cycles_read() < count) {
      const RecordedInput* const input = reader->next();
      ByteWriter out(records);
      write_records(input->view(), out);
      TappedCycle cycle;
      cycle.head.cycle = reader->cycles_read() - 1;
      cycle.head.now_ns = input->now_ns;
      cycle.records = out.written();
      block.add(cycle);
    }
    return {block.content().begin(), block.content().end()};
  }

  Bytes with(BlockKind kind, ByteSpan content, ByteSpan before) {
    Bytes file(before.begin(), before.end()), sealed;
    if (content.empty()) return file;
    seal_block(kind, content, sealed);
    file.insert(file.end(), sealed.begin(), sealed.end());
    return file;
  }

  Bytes beginning() {
    Bytes file = recording_header();
    write_preface(drive.preface(),
                  [&](ByteSpan block) { file.insert(file.end(), block.begin(), block.end()); });
    return file;
  }

  // How many cycles were driven.
  std::uint64_t replay(ByteSpan bytes) {
    std::ofstream(path("made_up.zpr"), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    auto reader = RecordingReader::open(path("made_up.zpr"));
    if (!reader) return 0;
    const auto result = replay_recording(*reader, drive.run(), "");
    return result ? result->replay.summary.cycles : 0;
  }

  test_support::TemporaryFolder folder;
  testing_support::RecordedDrive drive;
};

TEST_F(RecordingMutation, OfInputsWithRightChecksumsDoesNotLeadTheReplayAstray) {
  constexpr std::uint64_t kCycles = 300;
  const Bytes before = beginning(), content = first_cycles(kCycles);
  EXPECT_EQ(replay(with(BlockKind::kCycles, content, before)), kCycles);
  fuzz::Mutator mutator(11);
  std::uint64_t whole = 0;
  for (int round = 0; round < 500; ++round) {
    whole += replay(with(BlockKind::kCycles, mutator(content), before)) == kCycles;
  }
  EXPECT_GT(whole, 50u);   // many changes are still inputs
  EXPECT_LT(whole, 450u);  // others are refused
}

TEST_F(RecordingMutation, OfCheckpointsDoesNotLeadTheReplayAstray) {
  Checkpoint checkpoint;
  checkpoint.cycle = 5000;
  checkpoint.now_ns = 1'000'000'000;
  checkpoint.has_pose = true;
  checkpoint.resident = {{.zone = 3, .generation = 2}, {.zone = 4, .generation = 1}};
  checkpoint.pinned = {7};
  checkpoint.route = {1, 2, 3};
  checkpoint.lost = true;
  checkpoint.sought = 5;
  CycleBlockWriter block(10'000'000);
  TappedCycle cycle;
  for (cycle.head.cycle = 5000; cycle.head.cycle < 5020; ++cycle.head.cycle) {
    cycle.head.now_ns = 1'000'000'000 + static_cast<std::int64_t>(cycle.head.cycle) * 10'000'000;
    block.add(cycle);
  }
  const Bytes before = beginning(), content = write_checkpoint(checkpoint);
  const auto file = [&](const Bytes& told) {
    return with(BlockKind::kCycles, block.content(), with(BlockKind::kCheckpoint, told, before));
  };
  EXPECT_EQ(replay(file(content)), 20u);
  fuzz::Mutator mutator(12);
  std::uint64_t whole = 0;
  for (int round = 0; round < 500; ++round) whole += replay(file(mutator(content))) == 20;
  EXPECT_GT(whole, 50u);
  EXPECT_LT(whole, 450u);
}

TEST_F(RecordingMutation, OfWholeFilesIsFoundByChecksums) {
  const Bytes file = with(BlockKind::kCycles, first_cycles(300), beginning());
  fuzz::Mutator mutator(13);
  for (int round = 0; round < 500; ++round) {
    const Bytes changed = mutator(file);
    // The minor version and the four bytes after it may be anything.
    if (std::equal(file.begin() + 16, file.end(), changed.begin() + 16, changed.end())) continue;
    EXPECT_EQ(replay(changed), 0u) << "round " << round;
  }
}

TEST_F(RecordingMutation, OfPrefacesIsReadOrRefused) {
  Bytes content;
  write_preface(drive.preface(), [&](ByteSpan block) { ASSERT_TRUE(open_block(block, content)); });
  ASSERT_TRUE(read_preface(content).ok());
  fuzz::Mutator mutator(14);
  std::size_t read = 0;
  for (int round = 0; round < 5000; ++round) read += read_preface(mutator(content)).ok();
  EXPECT_GT(read, 100u);
  EXPECT_LT(read, 4999u);
}

}  // namespace
}  // namespace zonepack
