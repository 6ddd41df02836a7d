// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/log_faults.hpp"

#include <iostream>

namespace zonepack {

void tell_log_faults(const std::string& path, const CanLogSummary& summary) {
  for (const CanLogSummary::Fault& fault : summary.faults) {
    std::cerr << path << ':' << fault.line << ": " << fault.what << '\n';
  }
  const std::uint64_t all = summary.broken_lines + summary.stray_stamps;
  if (all > summary.faults.size()) {
    std::cerr << path << ": " << all - summary.faults.size() << " further lines left out\n";
  }
  if (summary.read_error != 0) {
    std::cerr << path << ": could not be read to its end (errno " << summary.read_error << ")\n";
  }
}

}  // namespace zonepack
