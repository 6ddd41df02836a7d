// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/preload_modes.hpp"

#include <algorithm>

namespace zonepack {
namespace {

void forget_habits(CycleConfig& config) {
  config.preload.transitions.clear();
  config.preload.learn = false;
}

}  // namespace

const std::vector<PreloadMode>& preload_modes() {
  static const std::vector<PreloadMode> kAll = {
      {"none",
       [](CycleConfig& config) {
         forget_habits(config);
         config.preload.off = true;
       },
       false, false},
      {"portal", forget_habits, true, true},
      {"transitions",
       [](CycleConfig& config) {
         if (config.preload.transitions.empty()) config.preload.learn = true;
       },
       true, true, true},
      {"route", [](CycleConfig&) {}, true, true, true, true}};
  return kAll;
}

const PreloadMode* find_preload(std::string_view name) {
  const auto& all = preload_modes();
  const auto found = std::ranges::find(all, name, &PreloadMode::name);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace zonepack
