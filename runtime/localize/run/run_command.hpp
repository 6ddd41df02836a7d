// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "runtime/localize/camera/image_source.hpp"

namespace zonepack::localize {

struct CameraRunArguments {
  std::string calibration;  // file
  CameraChoice camera;
  std::string camera_text;        // as it was given, for people
  std::string socket;             // of zoned; empty: ZONED_SOCKET, else the usual place
  std::string json;               // file of the summary; "-": standard output
  std::optional<double> seconds;  // how long; nothing: until SIGTERM
};

// `zoneloc run`: looks at the images of a camera, finds the robot's pose among the zones that zoned
// holds, and gives it to zoned, until SIGTERM, SIGINT or the end of the images. Images that are of
// no use are named, and nothing is sent for them. When zoned ends, tries once a second to find
// another. Returns the exit code: 0, or 1 when something could not begin or the camera broke.
int run_localizer(const CameraRunArguments& arguments);

}  // namespace zonepack::localize
