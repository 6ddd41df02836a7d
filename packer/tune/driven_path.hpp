// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "runtime/pack_format/file/geometry.hpp"

// Where a robot was, as text files say it.
namespace zonepack::packer::tune {

struct DrivePose {
  double t_s = 0;
  Point2 p_map;
  double z_map_m = 0;
};

struct DrivenPath {
  std::string file;
  bool fixes = false;            // of a localizer; else a path
  std::vector<DrivePose> poses;  // ascending stamps
  std::size_t left_out = 0;      // fixes that contradict those before and after them
};

// Reads a path, "stamp x y z qx qy qz qw" and whatever follows, or a localizer's fixes, "stamp
// received x y yaw" and whatever follows; its content says which. Numbers are separated by blanks,
// tabs, commas or semicolons; stamps are seconds or whole nanoseconds; lines that begin with # are
// remarks, one line of column names is left out. Fixes that are metres off both the one before and
// the one after, further than a robot goes in the time, are left out.
// Throws std::runtime_error with file and line for anything else.
DrivenPath read_driven_path(const std::string& file);

// The same of a text; `file` is for messages.
DrivenPath parse_driven_path(const std::string& text, const std::string& file);

}  // namespace zonepack::packer::tune
