// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include "runtime/control/event.hpp"
#include "runtime/recording/checkpoint.hpp"
#include "runtime/recording/cycle_block.hpp"
#include "runtime/recording/flight_recorder.hpp"
#include "runtime/recording/input_tap.hpp"
#include "runtime/recording/map_block.hpp"
#include "runtime/recording/recording_file.hpp"

namespace zonepack {

// Carries the inputs of cycles from the tap to the files.
//
// Call drain() several times a second, so that the tap does not overflow. What is older than
// kMostWait_ns is written: a crash costs no more than that.
//
// Memory: two blocks, a quarter of a megabyte unless cycles may take hundreds of frames.
// Threads: one; not for the control thread. Allocates in the constructor, and for checkpoints.
class InputWriter {
 public:
  static constexpr std::int64_t kMostWait_ns = 1'000'000'000;

  // `file` and `flight` may be null; all must outlive this object. zones: of the map.
  InputWriter(InputTap& tap, std::int64_t period_ns, std::size_t zones, RecordingFile* file,
              FlightRecorder* flight);

  // For checkpoints: the run's events, as they come.
  void on_event(const Event& event) { mirror_.on_event(event); }

  // The map that events belong to from here on.
  void change_map(std::uint32_t number, std::size_t zones) { mirror_.change_map(number, zones); }

  // For checkpoints: gives what the run learned, as a .zpt; may be null.
  void learns_by(std::function<std::vector<std::byte>()> habits) { habits_ = std::move(habits); }

  // A map that a future cycle will be offered; any thread.
  void add_map(const RecordedMap& map);

  // Takes what the tap holds; writes the blocks that became full or old. now_ns: CLOCK_MONOTONIC.
  void drain(std::int64_t now_ns);
  // The same, and writes what is left.
  void flush();

  // The recording's end for RecordingFile::finish(), after flush().
  RecordingEnd end() const;
  // Cycles that are missing from the recording, or from its end; any thread.
  std::uint64_t lost() const noexcept;

 private:
  void take_all(std::int64_t now_ns);
  void take(const TappedCycle& cycle, std::int64_t now_ns);
  void begin_block(const TappedCycle& cycle);
  void write_offered(const TappedCycle& cycle);
  void end_block();

  InputTap& tap_;
  RecordingFile* file_;
  FlightRecorder* flight_;
  RunMirror mirror_;
  std::function<std::vector<std::byte>()> habits_;
  CycleBlockWriter block_;
  std::vector<std::byte> sealed_;
  RecordedInput input_;
  std::int64_t block_began_ns_ = 0;  // CLOCK_MONOTONIC
  std::int64_t start_ns_ = 0;        // the run's clock, of cycle 0
  std::uint64_t next_cycle_ = 0;
  std::mutex mutex_;                                                      // guards what follows
  std::vector<std::pair<std::uint32_t, std::vector<std::byte>>> coming_;  // maps as blocks
};

}  // namespace zonepack
