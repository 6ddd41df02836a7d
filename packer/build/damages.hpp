// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "packer/record/damage.hpp"

namespace zonepack::packer {

// What becomes of signatures that cannot be read whole, or fit in no pack.
enum class DamagedPolicy : std::uint8_t { kSkip, kError };

std::vector<Damage> sorted(std::vector<Damage> damages);

// Throws std::runtime_error that names the first damages when there are any and the policy is
// kError.
void refuse_damaged(const std::vector<Damage>& damages, DamagedPolicy policy,
                    const std::string& database);

}  // namespace zonepack::packer
