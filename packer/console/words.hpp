// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "platform/base/counted.hpp"  // IWYU pragma: export
#include "runtime/pack_format/chunk_view.hpp"

// Counts, sizes and payloads as the commands print them.
namespace zonepack::packer {

// For columns and sentences: "0.17", in MiB, two decimals; what is smaller but not 0 as "0.01".
std::string mib_text(ByteCount bytes);

// "180224 bytes (0.17 MiB)"; below 0.01 MiB the bytes alone.
std::string size_text(ByteCount bytes);

// "features,scan,grid".
std::string payload_text(PayloadMask mask);

// The indices of names in the order of natural_less().
std::vector<std::size_t> natural_order(const std::vector<std::string>& names);

}  // namespace zonepack::packer
