// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

// The commands of zonectl. Each says what it did on standard output, or why it could not on
// standard error, and returns the exit code: 0 done, 1 zoned or the world said no, 2 usage.
namespace zonepack {

struct CtlArguments {
  std::string socket;  // of --socket; empty: $ZONED_SOCKET, --config, the usual place
  std::string config;  // settings whose serve.socket is meant
};

// The socket's path; nothing, with a message told, when the settings cannot be read.
std::optional<std::string> socket_path(const CtlArguments& arguments);

struct PoseArguments {
  double x_m = 0, y_m = 0, yaw_deg = 0, sigma_m = 0.1, sigma_yaw_deg = 5;
};

int ctl_status(const std::string& socket, const std::string& json);
int ctl_zones(const std::string& socket);
int ctl_events(const std::string& socket);
int ctl_watch(const std::string& socket);
int ctl_metrics(const std::string& socket);
int ctl_pin(const std::string& socket, const std::string& zone, bool pin);
int ctl_freeze(const std::string& socket, bool freeze);
int ctl_pose(const std::string& socket, const PoseArguments& pose);
int ctl_route(const std::string& socket, const std::string& from, const std::string& to, bool hint);
int ctl_dump(const std::string& socket, const std::string& file);

}  // namespace zonepack
