// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>

#include "platform/base/failure.hpp"
#include "platform/files/output_place.hpp"

namespace zonepack {

// An option that names a file to write; an empty path: not given; "-": standard output, where the
// option knows that.
struct OutputChoice {
  const char* option;
  const std::string& path;
  bool may_be_standard_output = false;
  Overwriting overwriting = Overwriting::kByRename;
};

// Before a run: whether each file could be written, so that a long run is not made for nothing. All
// that cannot are named at once. Standard output holds one of them: exit code 2 where two want it.
Outcome<void> check_outputs(std::initializer_list<OutputChoice> outputs);

// The file's name for people: "standard output" for "-".
inline std::string output_name(const std::string& path) {
  return path == "-" ? "standard output" : path;
}

}  // namespace zonepack
