// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "packer/record/record.hpp"

namespace zonepack::fuzz {

// Inputs that the entries accept, taken from small maps of every payload kind, and DBC files.
struct Seeds {
  std::vector<packer::Bytes> packs, indexes, chunks, blocks, manifests, dbcs;
};

const Seeds& seeds();

}  // namespace zonepack::fuzz
