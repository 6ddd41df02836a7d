// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "runtime/pack_format/file/geometry.hpp"

// What is wrong with a zone file, in messages that suffice to correct it.
namespace zonepack::packer {

struct Finding {
  std::optional<std::size_t> feature;  // index in the file's list, from 0; nullopt: the file itself
  std::size_t line = 0;                // where the feature begins, from 1; 0: unknown
  std::string name;                    // zone or portal; empty when it has none
  std::string message;                 // complete: what was found, what was expected, what to do
};

struct Findings {
  std::vector<Finding> faults;    // the file is rejected
  std::vector<Finding> warnings;  // the file is accepted, but a person should look at it
};

// "FILE:LINE: message", without the line when unknown.
std::string to_string(const Finding& finding, const std::string& file);

// Every fault on its own line, under a heading that counts them.
std::string describe_faults(const Findings& findings, const std::string& file);

// "1.25", at most three digits after the point.
std::string number_text(double value);
// "(1.25, -3)".
std::string point_text(Point2 point);

}  // namespace zonepack::packer
