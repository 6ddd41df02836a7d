// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/preload_modes.hpp"

#include <algorithm>

namespace zonepack {

const std::vector<PreloadMode>& preload_modes() {
  static const std::vector<PreloadMode> kAll = {
      {"none", [](CycleConfig& config) { config.preload.off = true; }, false, false},
      {"portal", [](CycleConfig&) {}, true, true}};
  return kAll;
}

const PreloadMode* find_preload(std::string_view name) {
  const auto& all = preload_modes();
  const auto found = std::ranges::find(all, name, &PreloadMode::name);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace zonepack
