// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zonepack {

// A zone's index in the manifest's list, which is sorted by name. Valid for one map version only.
using ZoneId = std::uint32_t;
inline constexpr ZoneId kNoZone = 0xFFFFFFFFu;

// The source database's node id.
using SignatureId = std::int32_t;

}  // namespace zonepack
