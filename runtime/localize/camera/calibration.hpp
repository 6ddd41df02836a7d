// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "platform/base/failure.hpp"
#include "runtime/localize/camera/camera_model.hpp"

namespace zonepack::localize {

// Reads a calibration as ROS's camera_calibration and RTAB-Map write it (YAML, also with OpenCV's
// %YAML:1.0 line): image_width, image_height, camera_matrix, distortion_coefficients (0, 4 or 5
// values), distortion_model (plumb_bob, or absent), local_transform (T_base_camera, 3x4, row by
// row). A failure names the file and the key.
Outcome<CameraModel> read_calibration(const std::string& file);

// The same from the text of a file; `name` stands in messages.
Outcome<CameraModel> parse_calibration(const std::string& text, const std::string& name);

}  // namespace zonepack::localize
