// SPDX-License-Identifier: Apache-2.0
#include "packer/build/damages.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <tuple>

namespace zonepack::packer {

std::vector<Damage> sorted(std::vector<Damage> damages) {
  std::ranges::sort(damages, {}, [](const Damage& d) { return std::tie(d.signature, d.column); });
  return damages;
}

void refuse_damaged(const std::vector<Damage>& damages, DamagedPolicy policy,
                    const std::string& database) {
  if (damages.empty() || policy == DamagedPolicy::kSkip) return;
  constexpr std::size_t kShown = 20;
  const std::vector<Damage> shown = sorted(damages);
  std::string text = database + ": " + std::to_string(shown.size()) +
                     (shown.size() == 1 ? " signature" : " signatures") +
                     " damaged or beyond what a pack holds; repair the database, or leave them out "
                     "with --damaged skip";
  for (std::size_t i = 0; i < std::min(shown.size(), kShown); ++i) {
    // A row whose own id is wrong has no number to be named by.
    const std::string which =
        shown[i].signature == 0 ? "a signature" : "signature " + std::to_string(shown[i].signature);
    text += "\n  " + which + ", " + shown[i].column + ": " + shown[i].problem;
  }
  if (shown.size() > kShown) text += "\n  and " + std::to_string(shown.size() - kShown) + " more";
  throw std::runtime_error(text);
}

}  // namespace zonepack::packer
