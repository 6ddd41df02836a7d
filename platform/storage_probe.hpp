// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "platform/base/result.hpp"

namespace zonepack {

// What may stand between every StorageFile and its disk: a test that makes it fail, stall or tell
// (platform/sim/sim_storage.hpp). A robot has none.
class StorageProbe {
 public:
  using FileMark = std::uint32_t;  // 0: a file whose reads do not matter

  virtual ~StorageProbe() = default;

  // Before a file is opened; its error is the opener's.
  virtual Result<FileMark> on_open(const std::string& path) noexcept = 0;

  // Before bytes of a marked file are read or mapped, on the thread that reads; its error is the
  // reader's.
  virtual Result<void> on_read(FileMark file, std::uint64_t offset,
                               std::uint64_t size) noexcept = 0;
};

// From now on; nullptr for none. Files opened under one probe must be gone before the next.
void set_storage_probe(StorageProbe* probe) noexcept;

}  // namespace zonepack
