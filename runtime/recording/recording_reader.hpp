// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/files/storage.hpp"
#include "runtime/recording/checkpoint.hpp"
#include "runtime/recording/cycle_block.hpp"
#include "runtime/recording/map_block.hpp"
#include "runtime/recording/preface.hpp"
#include "runtime/recording/recording_end.hpp"

namespace zonepack {

// Reads a recording from its first cycle to the last sound one.
//
// Invariant: whatever the bytes are, the cycles it returns are whole, checked and without a gap.
// Memory: the preface, the maps and one block.
// Threads: one; allocates.
class RecordingReader {
 public:
  // A recording, or the folder of a flight recorder. Fails when it cannot be read up to its first
  // cycle.
  static Outcome<RecordingReader> open(const std::string& path);

  const RecordingPreface& preface() const noexcept { return preface_; }
  // The state of the run before the first cycle; nothing when that is cycle 0.
  const std::optional<Checkpoint>& checkpoint() const noexcept { return checkpoint_; }
  std::uint64_t first_cycle() const noexcept { return next_cycle_first_; }

  // A map that the last next(), or the checkpoint, refers to by its number; null: it is missing.
  const RecordedMap* map(std::uint32_t number) const noexcept { return maps_.find(number); }

  // The next cycle, valid until the next call; null at the end.
  const RecordedInput* next();
  // The number of the cycle that next() gave last, plus one.
  std::uint64_t cycles_read() const noexcept { return next_cycle_; }

  // After the last cycle. Why it is the last, when the run did not end there: a complete message;
  // empty when it did.
  const std::string& note() const noexcept { return note_; }
  // False when cycles of the run are missing: cut off, damaged or lost.
  bool complete() const noexcept { return complete_; }
  const std::optional<RecordingEnd>& end() const noexcept { return end_; }

 private:
  explicit RecordingReader(std::string path) : path_(std::move(path)) {}

  Outcome<void> open_files();
  Outcome<void> read_start();
  // Reads the next block into block_ and returns its kind; nothing at the end of the files.
  Result<std::optional<std::uint8_t>> read_block();
  bool next_block();
  void stop(const std::string& why, bool complete = false);

  std::string path_;
  std::vector<StorageFile> files_;  // read one after another
  std::size_t file_ = 0;
  std::uint64_t offset_ = 0;
  RecordingPreface preface_;
  std::optional<Checkpoint> checkpoint_;
  RecordedMaps maps_;
  std::optional<RecordingEnd> end_;
  std::vector<std::byte> stored_;
  std::vector<std::byte> block_;
  CycleBlockReader cycles_;
  RecordedInput input_;
  std::uint64_t next_cycle_first_ = 0;
  std::uint64_t next_cycle_ = 0;
  std::int64_t last_ns_ = 0;
  bool stopped_ = false;
  bool complete_ = false;
  std::string note_;
};

}  // namespace zonepack
