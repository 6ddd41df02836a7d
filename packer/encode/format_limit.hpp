// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "runtime/pack_format/limits.hpp"

namespace zonepack::packer {

// What the packer says of something beyond a limit of the format: "vertices of a zone: 4097, the
// format holds at most 4096; simplify its outline".
std::string limit_text(LimitId id, std::uint64_t found);

// Throws std::runtime_error with that text, after `what` ("zone kitchen") unless it is empty.
void require_within(LimitId id, std::uint64_t found, const std::string& what = {});

}  // namespace zonepack::packer
