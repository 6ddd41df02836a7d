// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/output_check.hpp"

namespace zonepack {

Outcome<void> check_outputs(std::initializer_list<OutputChoice> outputs) {
  const char* taken_by = nullptr;
  Failures failed;
  for (const OutputChoice& output : outputs) {
    if (output.path.empty()) continue;
    if (output.path == "-" && output.may_be_standard_output) {
      if (taken_by != nullptr) {
        return usage_failure(std::string(taken_by) + " - and " + output.option +
                             " -: standard output takes one of them; give the other a FILE");
      }
      taken_by = output.option;
      continue;
    }
    const auto possible = check_output_place(output.path, output.overwriting);
    if (possible) continue;
    Failure why = cannot_write(output.path, possible.error());
    why.message = std::string(output.option) + ": " + why.message;
    failed.add(why);
  }
  return failed.all();
}

}  // namespace zonepack
