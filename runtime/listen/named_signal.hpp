// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/odometry/can_signals.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {

// A signal that the settings name, as people know it.
struct NamedSignal {
  std::string key;      // of the section odometry; empty: odometry does not read it
  std::string message;  // of the DBC file, or the node of CANopen; may be empty
  std::string name;
  std::string unit;  // of the value; empty: not known
  CanSignal signal;
  bool wheel = false;                 // a distance or speed of a wheel
  bool position = false;              // counts what was covered
  double si_per_unit = 1;             // m, m/s, rad or rad/s, with the sign, of what odometry reads
  std::optional<double> least, most;  // of the value: by the DBC file, else what odometry believes
};

// Those of odometry in the order of the model, then the others of can.signals.
std::vector<NamedSignal> named_signals(const Settings& settings);

using MessageId = std::pair<std::uint32_t, bool>;  // id, 29 bits

// The messages of the DBC file: 0x221 is "Motion".
std::map<MessageId, std::string> message_names(const Settings& settings);

// Text for a terminal: well-formed UTF-8 without control characters.
std::string printable(std::string_view text);

}  // namespace zonepack
