// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "platform/base/failure.hpp"
#include "runtime/recording/input_tap.hpp"
#include "runtime/recording/input_writer.hpp"
#include "runtime/recording/preface.hpp"
#include "runtime/run/run.hpp"

namespace zonepack {

struct RecordingChoice {
  std::string file;            // --record; empty: none
  std::string state_folder;    // where the flight recorder keeps its files; empty: without names
  ByteCount flight_bytes = 0;  // 0: no flight recorder
};

// The recordings of a live run: the one that was asked for, and the flight recorder's.
//
// Threads: tap() belongs to the control thread, on_event() and drain() to the log thread; flight()
// and add_map() are for any; the rest is called while neither runs.
class RunRecording final : public RunObserver {
 public:
  // Before the threads start. Fails when the file that was asked for cannot be written; a flight
  // recorder that cannot be opened is a warning, returned as a complete message or empty.
  Outcome<std::string> open(const RecordingChoice& choice, const RecordingPreface& preface,
                            std::size_t zones, std::uint32_t most_frames);

  // For checkpoints: what the run learned, as a .zpt. Set before open(); may stay null.
  std::function<std::vector<std::byte>()> habits;

  // A map that the run is going to be offered. Any thread.
  void add_map(const RecordedMap& map) {
    if (writer_) writer_->add_map(map);
  }

  // Null when nothing is recorded.
  InputTap* tap() noexcept { return tap_.get(); }
  FlightRecorder* flight() noexcept { return flight_.get(); }

  void on_event(const Event& event, const MapVersion& map) noexcept override;
  void drain();

  // Ends the recording. Fails when it is not whole.
  Outcome<void> finish(const std::string& event_log_hash);

 private:
  std::string path_;
  std::uint32_t map_ = 1;  // number of the map that events are of
  std::unique_ptr<InputTap> tap_;
  std::unique_ptr<RecordingFile> file_;
  std::unique_ptr<FlightRecorder> flight_;
  std::unique_ptr<InputWriter> writer_;
};

}  // namespace zonepack
