// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "platform/base/result.hpp"
#include "platform/can/can_bus.hpp"
#include "platform/can/can_frame_source.hpp"
#include "platform/can/can_log_asc.hpp"
#include "platform/can/can_log_line.hpp"
#include "platform/files/read_stream.hpp"

namespace zonepack {

// What reading a log has found so far. Lines count from 1.
struct CanLogSummary {
  struct Fault {
    std::uint64_t line = 0;
    std::string what;  // the reason and the start of the line
  };
  struct ClockStep {
    std::uint64_t line = 0;      // of the first frame after it
    std::int64_t before_ns = 0;  // the latest stamp before it, as the log has it
    std::int64_t after_ns = 0;   // that frame's
  };
  std::uint64_t lines = 0;
  std::uint64_t frames = 0;  // returned, or read ahead
  std::uint64_t broken_lines = 0;
  std::uint64_t stray_stamps = 0;      // frames skipped: stamp far later than both neighbours
  std::uint64_t unsorted_stamps = 0;   // frames with a stamp before the latest one so far
  std::uint64_t clock_steps = 0;       // times that the clock of the stamps was set
  std::uint64_t other_interfaces = 0;  // frames that the interface filter skipped
  std::string other_names;             // of their interfaces: "can1, can2"; cut after some
  std::string interface;               // whose frames are returned; empty: all
  std::uint64_t error_frames = 0;
  std::uint64_t dropped = 0;     // as DROPCOUNT lines report
  int read_error = 0;            // errno that ended the file early; 0: read to its end
  std::vector<Fault> faults;     // the first kMostFaults of broken lines and stray stamps
  std::vector<ClockStep> steps;  // the first kMostFaults of clock_steps
};

// Reads a candump recording (formats: can_log_line.hpp) or a Vector ASC file from front to back,
// whatever its length: 64 frames ahead, in pieces that leave the page cache once they are read
// (read_stream.hpp).
//
// A broken line is counted, recorded with its number and skipped; only a file without a single
// valid frame is an error. The order of the file is the order of arrival: frames whose stamp steps
// back are counted and returned as they are (SimCanBus defines when they arrive), except a single
// frame stamped over an hour after both neighbours, which is counted and skipped.
//
// Returned stamps are on one clock, that of the first frame. Where stamps go on more than
// kLongestSilence_ns later, or lastingly over kMostDisorder_ns earlier, the clock was set (a robot
// without a battery starts in 1970): time goes on across it as on the live bus, the first frame
// after it coming one period of its id after the last.
class CanLogReader final : public CanFrameSource {
 public:
  static constexpr std::size_t kMostFaults = 20;
  static constexpr std::int64_t kLongestSilence_ns = 10'000'000'000;
  static constexpr std::int64_t kMostDisorder_ns = 1'000'000'000;

  // interface: "can0" selects that bus's frames; empty selects all. A recording that holds exactly
  // one bus, under another name, counts as this bus: its name differs between machines.
  explicit CanLogReader(std::string path, std::string interface = {});
  ~CanLogReader() override;

  // Opens the file and reads ahead. Errors: kNotFound, kIo (errno); kBadStructure: no valid frame
  // in the whole file; kBadValue: stamps are time differences (candump -td), which do not give a
  // pose.
  Result<void> open();

  // The message for open()'s error: file, line, what was expected, what to do.
  std::string explain(const Error& error) const;

  // The next frame; nullopt at the end of the file.
  std::optional<CanFrame> next() noexcept override;

  // What has been added to the stamp of the last frame that next() returned.
  std::int64_t added_ns() const noexcept { return added_ns_; }

  // DROPCOUNT losses before the frames returned so far.
  std::uint64_t dropped() const noexcept override { return dropped_before_; }

  const CanLogSummary& summary() const noexcept { return summary_; }

 private:
  struct Item {
    CanFrame frame;
    std::uint64_t dropped = 0;
    std::uint64_t line = 0;
  };
  struct Rhythm {  // of the frames of an id, on the clock of the first frame
    CanId id;
    std::int64_t last_ns = 0;
    std::int64_t period_ns = 0;
  };
  static constexpr std::size_t kMostRhythms = 64;
  static constexpr std::size_t kAhead = 64;
  static constexpr std::size_t kLongestLine = 1024;

  int read_byte();
  bool read_line(std::string_view& line);
  std::optional<Item> read_frame();
  void refill();
  void note(std::uint64_t line, std::string_view what, std::string_view text);
  void name_other(std::string_view name);
  Result<void> start();
  bool stamps_are_differences() const noexcept;
  bool is_stray(const Item& item) const noexcept;
  bool clock_was_set_before(const Item& item) const noexcept;
  void bridge(const Item& item) noexcept;
  void note_arrival(const CanFrame& frame) noexcept;

  std::string path_;
  std::string interface_;
  std::optional<ReadStream> file_;
  std::span<const char> piece_;  // of the file, not yet taken
  std::array<char, kLongestLine> line_{};
  std::array<Item, kAhead> ahead_{};  // a ring: frames read but not yet returned
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  bool end_ = false;
  bool relative_ = false;
  std::string other_;  // the first interface skipped
  CanAscLines asc_lines_;
  bool asc_ = false;
  const char* foreign_ = nullptr;  // what else the log is; a static text
  bool several_others_ = false;
  bool given_ = false;
  std::int64_t latest_ns_ = 0;  // largest stamp since the clock was set, as the log has it
  std::int64_t added_ns_ = 0;   // from the log's clock to the first frame's
  std::array<Rhythm, kMostRhythms> rhythms_{};
  std::size_t rhythm_count_ = 0;
  std::uint64_t dropped_before_ = 0;
  CanLogSummary summary_;
};

}  // namespace zonepack
