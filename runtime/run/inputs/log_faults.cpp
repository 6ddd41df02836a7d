// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/inputs/log_faults.hpp"

#include <iostream>

namespace zonepack {
namespace {

constexpr std::int64_t kPerSecond_ns = 1'000'000'000;

// As candump writes it: seconds to the microsecond.
std::string stamp_text(std::int64_t stamp_ns) {
  std::string micros = std::to_string(stamp_ns % kPerSecond_ns / 1000);
  micros.insert(0, 6 - micros.size(), '0');
  return std::to_string(stamp_ns / kPerSecond_ns) + "." + micros + " s";
}

// "54.5 years later", in the largest unit that it is two of.
std::string step_text(std::int64_t step_ns) {
  struct Unit {
    const char* name;
    double seconds;
  };
  constexpr Unit kUnits[] = {
      {"years", 31'557'600}, {"days", 86'400}, {"hours", 3600}, {"minutes", 60}, {"seconds", 1}};
  const double seconds = static_cast<double>(step_ns < 0 ? -step_ns : step_ns) / 1e9;
  const Unit* unit = kUnits;
  while (unit->seconds > 1 && seconds < 2 * unit->seconds) ++unit;
  const auto tenths = static_cast<std::int64_t>(seconds / unit->seconds * 10 + 0.5);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " " + unit->name +
         (step_ns < 0 ? " earlier" : " later");
}

}  // namespace

void tell_log_faults(const std::string& path, const CanLogSummary& summary) {
  for (const CanLogSummary::Fault& fault : summary.faults) {
    std::cerr << path << ':' << fault.line << ": " << fault.what << '\n';
  }
  for (const CanLogSummary::ClockStep& step : summary.steps) {
    std::cerr << path << ':' << step.line << ": the clock of the log was set from "
              << stamp_text(step.before_ns) << " to " << stamp_text(step.after_ns) << " ("
              << step_text(step.after_ns - step.before_ns)
              << "); time goes on across it, on the clock of the first line\n";
  }
  if (summary.clock_steps > summary.steps.size()) {
    std::cerr << path << ": its clock was set " << summary.clock_steps - summary.steps.size()
              << " more times\n";
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
