// SPDX-License-Identifier: Apache-2.0
#include "packer/encode/format_limit.hpp"

#include <stdexcept>

namespace zonepack::packer {

std::string limit_text(LimitId id, std::uint64_t found) {
  return to_string(Excess{id, found}) + "; " + limit(id).remedy;
}

void require_within(LimitId id, std::uint64_t found, const std::string& what) {
  if (!is_over(id, found)) return;
  throw std::runtime_error((what.empty() ? "" : what + ": ") + limit_text(id, found));
}

}  // namespace zonepack::packer
