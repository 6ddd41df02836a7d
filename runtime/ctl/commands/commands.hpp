// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "platform/base/failure.hpp"

// The commands of zonectl. Each writes what it did or found to standard output. json: the file that
// gets it as JSON instead; "-": standard output; empty: as text.
namespace zonepack {

struct CtlArguments {
  std::string socket;  // of --socket; empty: $ZONED_SOCKET, --config, the usual place
  std::string config;  // settings whose serve.socket is meant
};

// The path of zoned's socket; fails when the settings cannot be read or name none.
Outcome<std::string> socket_path(const CtlArguments& arguments);

struct PoseArguments {
  double x_m = 0, y_m = 0, yaw_deg = 0, sigma_m = 0.1, sigma_yaw_deg = 5;
};

Outcome<void> ctl_status(const std::string& socket, const std::string& json);
Outcome<void> ctl_zones(const std::string& socket, const std::string& json);
Outcome<void> ctl_events(const std::string& socket, const std::string& json);
Outcome<void> ctl_watch(const std::string& socket);
Outcome<void> ctl_metrics(const std::string& socket);
Outcome<void> ctl_pin(const std::string& socket, const std::string& zone, bool pin);
Outcome<void> ctl_freeze(const std::string& socket, bool freeze);
Outcome<void> ctl_pose(const std::string& socket, const PoseArguments& pose);
Outcome<void> ctl_route(const std::string& socket, const std::string& from, const std::string& to,
                        bool hint, const std::string& json);
Outcome<void> ctl_dump(const std::string& socket, const std::string& file);

}  // namespace zonepack
