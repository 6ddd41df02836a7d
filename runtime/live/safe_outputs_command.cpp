// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/safe_outputs_command.hpp"

#include <iostream>

#include "runtime/live/gpio/line_requests.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {

int run_safe_outputs(const std::string& config) {
  const LoadedSettings loaded = load_settings(config);
  std::vector<std::string> faults = loaded.faults;
  if (loaded.ok()) faults = set_safe_outputs(kernel_gpio(), loaded.settings.gpio);
  for (const std::string& fault : faults) std::cerr << "zoned: " << fault << '\n';
  return faults.empty() ? 0 : 1;
}

}  // namespace zonepack
