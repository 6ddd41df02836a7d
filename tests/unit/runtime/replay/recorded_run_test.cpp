// SPDX-License-Identifier: Apache-2.0
// A recording of a run, replayed, gives the same events byte for byte.
#include "runtime/replay/recorded_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/runtime/recording/recorded_drive.hpp"

namespace zonepack {
namespace {

using testing::HasSubstr;
using testing_support::text_of;

class RecordedRunTest : public testing_support::ReplaysADrive {
 protected:
  void record(std::uint64_t seed) {
    auto file = RecordingFile::create(path("run.zpr"), drive.preface());
    ASSERT_TRUE(file.ok());
    live_hash = drive.drive(seed, path("live.jsonl"), file->get(), nullptr);
  }

  std::string live_hash;
};

TEST_F(RecordedRunTest, GivesTheSameEventsByteForByte) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    record(seed);
    const auto result = replay(path("run.zpr"));
    ASSERT_TRUE(result) << fault;
    EXPECT_TRUE(result->complete);
    EXPECT_TRUE(result->exact);
    EXPECT_EQ(note, "");
    EXPECT_EQ(result->replay.summary.budget_violations, 0u);
    EXPECT_EQ(result->replay.summary.event_log_hash, live_hash);
    EXPECT_EQ(result->live_hash, live_hash);
    ASSERT_EQ(text_of(path("again.jsonl")), text_of(path("live.jsonl"))) << "seed " << seed;
  }
  // The drives cover every kind of trouble.
  for (const char* word :
       {"load_cancelled", "load_given_up", "load_failed", "evicted", "blocked", "zone_entered",
        "correction_rejected", "not_keeping_up", "docked", "undocked", "hold_begun", "hold_ended",
        "zone_confirmed", "marker_ignored"}) {
    EXPECT_TRUE(drive.words.contains(word)) << word;
  }
}

// The same inputs except one, which shows that the events depend on it.
TEST_F(RecordedRunTest, DependsOnEveryInput) {
  record(1);
  auto reader = RecordingReader::open(path("run.zpr"));
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  auto changed = RecordingFile::create(path("changed.zpr"), drive.preface());
  CycleBlockWriter block(drive.preface().terms.period_ns);
  std::vector<std::byte> records(kMostCycleBytes), sealed;
  bool once = false;
  while (const RecordedInput* input = reader->next()) {
    RecordedInput other = *input;
    if (!once && reader->cycles_read() > 5000 && !other.corrections.empty()) {
      other.corrections[0].T_map_base.x_m += 0.05;
      once = true;
    }
    ByteWriter out(records);
    write_records(other.view(), out);
    TappedCycle cycle;
    cycle.head.cycle = reader->cycles_read() - 1;
    cycle.head.now_ns = other.now_ns;
    cycle.records = out.written();
    block.add(cycle);
    if (!block.full()) continue;
    seal_block(BlockKind::kCycles, block.content(), sealed);
    (*changed)->append(sealed);
    block.clear();
  }
  ASSERT_TRUE(once);
  const auto result = replay(path("changed.zpr"));
  // Either the events differ, or the cycle asks for loads that the recording does not know.
  if (result) {
    EXPECT_NE(text_of(path("again.jsonl")), text_of(path("live.jsonl")));
  } else {
    EXPECT_THAT(fault, HasSubstr("diverged at cycle"));
  }
}

TEST_F(RecordedRunTest, SaysAtWhichCycleItDiverges) {
  record(2);
  auto reader = RecordingReader::open(path("run.zpr"));
  std::uint64_t first_load = 0;
  while (const RecordedInput* input = reader->next()) {
    if (!input->loads.empty()) break;
    first_load = reader->cycles_read();
  }
  // Without a start the first fix is waited for, so a guess far away loads something else first.
  RecordingPreface preface = drive.preface();
  preface.terms.max_signatures = 0;
  preface.terms.pinned = {"R44"};
  auto other = RecordingFile::create(path("other.zpr"), preface);
  const std::string whole = text_of(path("run.zpr"));
  const std::uint64_t from =
      RecordingFile::create(path("head.zpr"), drive.preface()).value()->size();
  (*other)->append(std::as_bytes(std::span(whole)).subspan(from));
  const auto result = replay(path("other.zpr"));
  ASSERT_FALSE(result);
  EXPECT_THAT(fault, HasSubstr("diverged at cycle " + std::to_string(first_load)));
  EXPECT_THAT(fault, HasSubstr("zone R44 (generation 1) was asked for"));
}

TEST_F(RecordedRunTest, ReplaysWhatIsThereOfARecordingThatWasCutAnywhere) {
  record(3);
  const std::string whole = text_of(path("run.zpr"));
  const std::string live = text_of(path("live.jsonl"));
  std::uint64_t cycles = 0;
  for (const std::size_t size : {whole.size() / 3, whole.size() / 2, whole.size() - 1}) {
    std::ofstream(path("cut.zpr"), std::ios::binary) << whole.substr(0, size);
    const auto result = replay(path("cut.zpr"));
    ASSERT_TRUE(result) << fault;
    EXPECT_FALSE(result->complete);
    EXPECT_GT(result->next_cycle, cycles);
    cycles = result->next_cycle;
    EXPECT_THAT(note, HasSubstr("ends after cycle " + std::to_string(cycles - 1)));
    // All but the last line, which says that the run ends, is a beginning of what happened.
    std::string again = text_of(path("again.jsonl"));
    again.resize(again.rfind("{\"cycle\""));
    EXPECT_TRUE(live.starts_with(again));
  }
}

TEST_F(RecordedRunTest, EndsWhereCyclesWereLostAndSaysSo) {
  auto file = RecordingFile::create(path("run.zpr"), drive.preface());
  // The writer stalls from cycle 3000 on for long enough to overflow the tap.
  drive.drive(4, path("live.jsonl"), file->get(), nullptr,
              [&](std::uint64_t cycle, InputWriter& writer) {
                if (cycle < 3000 || cycle > 9000) writer.drain(static_cast<std::int64_t>(cycle));
              });
  const auto result = replay(path("run.zpr"));
  ASSERT_TRUE(result) << fault;
  EXPECT_FALSE(result->complete);
  EXPECT_GT(result->next_cycle, 4000u);
  EXPECT_LT(result->next_cycle, 9000u);
  EXPECT_THAT(note, HasSubstr("were lost"));
}

}  // namespace
}  // namespace zonepack
