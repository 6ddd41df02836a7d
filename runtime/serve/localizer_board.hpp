// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/protocol/protocol_generated.h"

namespace zonepack {

using LocalizerRows =
    flatbuffers::Offset<flatbuffers::Vector<flatbuffers::Offset<wire::Localizer>>>;

// The last report of each localizer that is connected.
//
// Memory: at most kMostLocalizers reports of kMostReportBytes.
// Threads: one, the server's.
class LocalizerBoard {
 public:
  static constexpr std::size_t kMostLocalizers = 4;
  static constexpr std::uint32_t kMostReasons = 16;
  static constexpr std::uint32_t kMostReasonBytes = 32;
  static constexpr std::uint32_t kMostCameraBytes = 128;
  static constexpr std::size_t kMostReportBytes = 2048;

  // Takes the place of the client's report before. kTooLarge: other clients have reports, and there
  // is room for no more; kBadValue: over one of the limits above.
  Result<void> take(std::uint64_t client, const wire::Localizer& report);

  void gone(std::uint64_t client) noexcept;

  // All of them, in the order in which they came.
  LocalizerRows put(flatbuffers::FlatBufferBuilder& to) const;

 private:
  struct Row {
    std::uint64_t client = 0;
    std::vector<std::uint8_t> report;  // a FlatBuffer
  };
  std::vector<Row> rows_;
};

}  // namespace zonepack
