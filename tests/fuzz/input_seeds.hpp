// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "packer/record/record.hpp"

namespace zonepack::fuzz {

// Inputs that the entries of input_entries.hpp accept.
struct InputSeeds {
  std::vector<packer::Bytes> geojson, settings, sqlite, msgpack, pcd, recordings, messages;
};

const InputSeeds& input_seeds();

// The files of tests/fuzz/corpus/KIND: inputs that once did harm, or that a fuzzer found to reach
// far. An entry may accept or refuse them.
std::vector<packer::Bytes> corpus(const std::string& kind);

}  // namespace zonepack::fuzz
