// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/recording/bytes.hpp"

namespace zonepack {

// A map that a run was offered after its start.
struct RecordedMap {
  std::uint32_t number = 0;         // in the run; the one of the preface is 1
  std::string folder;               // for messages
  std::vector<std::byte> manifest;  // the file's bytes
};

// The blocks that hold it, joined: one or more, all of the kind "map".
std::vector<std::byte> write_map(const RecordedMap& map);

// The maps of a recording, assembled from the contents of its map blocks as they come.
class RecordedMaps {
 public:
  // kBadStructure: not what write_map() writes; kTooLarge. Maps added before stay.
  Result<void> add(ByteSpan content);

  // Null when it is missing or incomplete.
  const RecordedMap* find(std::uint32_t number) const noexcept;

 private:
  std::vector<std::byte> begun_;  // of the map whose blocks are coming
  std::map<std::uint32_t, RecordedMap> maps_;
};

}  // namespace zonepack
