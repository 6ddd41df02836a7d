// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "platform/base/result.hpp"

namespace zonepack {

// A hook between every StorageFile and its disk, with which a test makes reads fail or stall, or
// records them (platform/sim/sim_storage.hpp). A robot has none.
class StorageProbe {
 public:
  using FileMark = std::uint32_t;  // 0: a file whose reads are not watched

  virtual ~StorageProbe() = default;

  // Called before a file is opened; an error goes to the opener.
  virtual Result<FileMark> on_open(const std::string& path) noexcept = 0;

  // Called before bytes of a marked file are read or mapped, on the reading thread; an error goes
  // to the reader.
  virtual Result<void> on_read(FileMark file, std::uint64_t offset,
                               std::uint64_t size) noexcept = 0;
};

// Applies from now on; nullptr for none. Files opened under one probe must be closed before the
// next.
void set_storage_probe(StorageProbe* probe) noexcept;

}  // namespace zonepack
