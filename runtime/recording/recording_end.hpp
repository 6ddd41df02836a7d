// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/recording/bytes.hpp"

namespace zonepack {

// The last block of a recording that was completed, not cut off.
struct RecordingEnd {
  bool run_ended = true;         // false: saved while the run went on
  std::uint64_t cycles = 0;      // the number that the next cycle would have had
  std::uint64_t lost = 0;        // cycles that could not be recorded
  std::string event_log_hash{};  // as in `zoned run --json`; empty: unknown
};

std::vector<std::byte> write_end(const RecordingEnd& end);
Result<RecordingEnd> read_end(ByteSpan content);

}  // namespace zonepack
