// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <span>

#include "tests/fuzz/nvblox_entries.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  zonepack::fuzz::read_voxels(std::as_bytes(std::span(data, size)));
  return 0;
}
