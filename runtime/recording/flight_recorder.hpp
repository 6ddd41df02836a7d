// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "platform/base/byte_count.hpp"
#include "platform/base/result.hpp"
#include "platform/files/append_file.hpp"
#include "platform/files/bounded_writer.hpp"
#include "runtime/recording/bytes.hpp"
#include "runtime/recording/checkpoint.hpp"
#include "runtime/recording/preface.hpp"

namespace zonepack {

// The latest part of a recording, always available: a ring of files of equal size, each beginning
// with a checkpoint, the oldest of which goes when a new one begins. Maps that the run was offered
// have files of their own, which go with the cycles that need them.
//
// The files are in a folder and survive a crash, or have no names and vanish with the process. The
// folder of the previous run is kept next to it as NAME-previous.
//
// Threads: one that appends; dump() by any other. Not for the control thread.
class FlightRecorder {
 public:
  static constexpr std::uint64_t kSegments = 8;
  static constexpr ByteCount kLeastBytes = kSegments * AppendFile::kSettleBytes;
  // Maps that were offered, each with a file and a descriptor. Beyond it, the oldest goes with the
  // segments that need it.
  static constexpr std::size_t kMostMaps = 8;

  // Keeps at most `bytes` of cycles and offered maps, never less than the newest segment and what
  // it needs, in files named in `folder` (created when missing; its own old
  // files are moved), or without names in `folder` when `named` is false. kIo with errno.
  static Result<std::unique_ptr<FlightRecorder>> open(const std::string& folder, bool named,
                                                      ByteCount bytes,
                                                      const RecordingPreface& preface);

  // Whether the next block should begin a segment: after an error, and when more maps were offered
  // than one may keep, too.
  bool wants_segment() const noexcept;
  // Begins a segment. After a gap, what precedes it is no longer part of a dump.
  void begin_segment(const Checkpoint& checkpoint, bool after_gap);
  // A map that cycle `cycle` was offered: its blocks. Before the cycle's own block.
  void add_map(std::uint32_t number, ByteSpan blocks, std::uint64_t cycle);
  // A block of cycles that ends before cycle `next_cycle`.
  void append(ByteSpan block, std::uint64_t next_cycle);

  struct Dumped {
    std::uint64_t first_cycle = 0, next_cycle = 0;
    ByteCount bytes = 0;
  };
  // Writes what is kept as one recording that appears atomically; kNotFound when no cycle is kept.
  Result<Dumped> dump(const std::string& path) const;
  // The same into an open file, from its current offset, within the writer's bounds.
  Result<Dumped> dump_to(BoundedWriter& to) const;

  // The size of all files now.
  ByteCount kept_bytes() const;
  // How often a file could not be written, and why the last time; any thread.
  std::uint64_t failures() const;
  Error last_error() const;

 private:
  struct Segment {
    AppendFile file;
    std::string path;  // empty: no name
    std::uint64_t first_cycle = 0;
    std::uint32_t map = 1;  // in use before it
    bool after_gap = false;
  };
  struct Map {
    AppendFile file;
    std::string path;
    std::uint32_t number = 0;
    std::uint64_t cycle = 0;  // that was offered it
  };
  struct Part {  // of a file, as a dump takes it
    std::shared_ptr<const AppendFile> file;
    std::uint64_t size = 0;
  };

  FlightRecorder(std::string folder, bool named, ByteCount bytes, AppendFile preface)
      : folder_(std::move(folder)),
        named_(named),
        bytes_(bytes),
        segment_bytes_(bytes / kSegments),
        preface_(std::move(preface)) {}

  void fail(Error error);
  void drop_oldest();
  void drop_unused_maps();
  bool needs(const Segment& segment, const Map& map) const noexcept;
  void make_room();
  std::deque<std::shared_ptr<Segment>> whole_segments() const;

  std::string folder_;
  bool named_;
  ByteCount bytes_;
  ByteCount segment_bytes_;
  AppendFile preface_;
  mutable std::mutex mutex_;  // guards what follows
  std::deque<std::shared_ptr<Segment>> segments_;
  std::deque<std::shared_ptr<Map>> maps_;
  std::uint64_t segment_number_ = 0;
  std::uint64_t next_cycle_ = 0;
  bool broken_ = true;  // the newest segment takes no more
  std::uint64_t failures_ = 0;
  Error last_error_;
};

}  // namespace zonepack
