// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/recording/block.hpp"
#include "runtime/recording/input_record.hpp"
#include "runtime/recording/input_tap.hpp"

// The content of a block of cycles (RECORDING.md): whole cycles, numbered one after the other, the
// first with its own number and time, so that each block can be read without the others.
namespace zonepack {

// Collects cycles until a block is worth storing.
class CycleBlockWriter {
 public:
  static constexpr std::size_t kGoodBytes = std::size_t{64} * 1024;

  // period_ns: the usual time from cycle to cycle, which is not stored again with each.
  // most_cycle_bytes: of one cycle's records.
  explicit CycleBlockWriter(std::int64_t period_ns, std::size_t most_cycle_bytes = kMostCycleBytes);

  bool empty() const noexcept { return out_.size() == 0; }
  bool full() const noexcept { return out_.size() >= kGoodBytes; }
  // Whether the cycle follows the block's last one; any cycle does when the block is empty.
  bool continues(std::uint64_t cycle) const noexcept { return empty() || cycle == next_cycle_; }

  // The block must not be full, and the cycle must continue it.
  void add(const TappedCycle& cycle);

  ByteSpan content() const noexcept { return out_.written(); }
  void clear() noexcept;

 private:
  std::int64_t period_ns_;
  std::vector<std::byte> buffer_;
  ByteWriter out_;
  std::uint64_t next_cycle_ = 0;
  std::int64_t now_ns_ = 0;
  std::int64_t clock_offset_ns_ = 0;
};

// Reads the cycles of such a content, which must outlive it.
class CycleBlockReader {
 public:
  // kBadStructure from next() when the content is too short for its head.
  explicit CycleBlockReader(ByteSpan content = {}) noexcept;

  bool at_end() const noexcept { return in_.ok() && in_.at_end(); }
  std::uint64_t next_cycle() const noexcept { return next_cycle_; }
  std::int64_t clock_offset_ns() const noexcept { return clock_offset_ns_; }

  // The next cycle. Errors of read_records().
  Result<void> next(RecordedInput& into);

 private:
  ByteReader in_;
  std::uint64_t next_cycle_ = 0;
  std::int64_t period_ns_ = 0;
  std::int64_t now_ns_ = 0;
  std::int64_t clock_offset_ns_ = 0;
};

}  // namespace zonepack
