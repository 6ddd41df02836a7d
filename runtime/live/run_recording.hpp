// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "runtime/control/event.hpp"
#include "runtime/recording/input_tap.hpp"
#include "runtime/recording/input_writer.hpp"
#include "runtime/recording/preface.hpp"

namespace zonepack {

struct RecorderChoice {
  std::string file;            // --record; empty: none
  std::string state_folder;    // where the flight recorder keeps its files; empty: without names
  ByteCount flight_bytes = 0;  // 0: no flight recorder
};

// The recordings of a live run: the one that was asked for, and the flight recorder's.
//
// Threads: tap() by the control thread; on_event() and drain() by the log thread; flight() by any;
// the rest while neither runs.
class RunRecording final : public EventSink {
 public:
  // Passes events on to `next`.
  explicit RunRecording(EventSink& next) : next_(next) {}

  // Before the threads start. False when the file that was asked for cannot be written, with a
  // complete message in `fault`; a flight recorder that cannot is a warning.
  bool open(const RecorderChoice& choice, const RecordingPreface& preface, std::size_t zones,
            std::uint32_t most_frames, std::string& fault, std::vector<std::string>& warnings);

  // The map that events are of from here on. The log thread.
  void change_map(std::uint32_t number, std::size_t zones) {
    if (writer_) writer_->change_map(number, zones);
  }
  // A map that the run is going to be offered. Any thread.
  void add_map(const RecordedMap& map) {
    if (writer_) writer_->add_map(map);
  }

  // Null when nothing is recorded.
  InputTap* tap() noexcept { return tap_.get(); }
  FlightRecorder* flight() noexcept { return flight_.get(); }

  void on_event(const Event& event) noexcept override;
  void drain();

  // Ends the recording; a complete message when it is not whole.
  std::optional<std::string> finish(const std::string& event_log_hash);

 private:
  EventSink& next_;
  std::string path_;
  std::unique_ptr<InputTap> tap_;
  std::unique_ptr<RecordingFile> file_;
  std::unique_ptr<FlightRecorder> flight_;
  std::unique_ptr<InputWriter> writer_;
};

}  // namespace zonepack
