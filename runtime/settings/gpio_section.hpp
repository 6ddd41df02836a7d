// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/settings/yaml_section.hpp"

namespace zonepack {

// Reads the section gpio of a settings file.
void read_gpio(YamlSection& file, GpioSettings& gpio, FaultList& faults);

}  // namespace zonepack
