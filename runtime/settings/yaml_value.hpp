// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "platform/base/failure.hpp"
#include "runtime/settings/field.hpp"

namespace zonepack {

// Stores what the node holds in `into`. A failure says what is wrong with it and what is allowed;
// the caller adds the place.
Outcome<void> parse_value(const YAML::Node& node, const FieldLimits& limits,
                          const FieldValue& into);

// The node's content, for a message: its text, "a list", "a section", "nothing".
std::string shown(const YAML::Node& node);

// "4", "0.413", "1e+12": the shortest text that reads back as the same number.
std::string number_text(double value);

std::string payload_words(PayloadMask mask);

}  // namespace zonepack
