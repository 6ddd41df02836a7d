// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "packer/record/record.hpp"

namespace zonepack::packer {

// Sorts the links of a signature by type and target, the order in which a pack holds them; equal
// ones keep their order.
void sort_links(std::vector<Link>& links);

}  // namespace zonepack::packer
