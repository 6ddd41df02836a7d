// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/gpio/line_requests.hpp"

#include <utility>

#include "runtime/control/line_edge.hpp"

namespace zonepack {
namespace {

bool safe_level(OutputKind kind, SafeLevel safe) {
  if (safe != SafeLevel::kUsual) return safe == SafeLevel::kActive;
  return kind == OutputKind::kFault;
}

GpioInputSettings input_of(const InputLine& line) {
  return {{line.chip, line.line},
          line.active_low,
          line.bias,
          static_cast<std::int64_t>(line.debounce_s * 1e9 + 0.5)};
}

LineFinding inspect(GpioPort& port, const std::string& name, const GpioLineName& line,
                    bool output) {
  LineFinding finding{"line " + name, {}, {}};
  const auto info = port.look(line);
  if (!info) {
    finding.fault = line_fault(port, name, line, info.error());
  } else if (!info->consumer.empty()) {
    finding.fault = line_fault(port, name, line, {ErrorCode::kBusy});
  } else if (info->output && !output) {
    finding.fault = line_fault(port, name, line, {ErrorCode::kMismatch});
  } else {
    finding.found = info->chip + ", line " + std::to_string(info->number) +
                    (info->name.empty() ? "" : " \"" + info->name + "\"") +
                    (output ? ", free for output" : ", free for input");
  }
  return finding;
}

}  // namespace

std::vector<OutputRequest> output_requests(const GpioSettings& gpio) {
  std::vector<OutputRequest> requests;
  const auto add = [&](const char* name, OutputKind kind, const std::optional<OutputLine>& line) {
    if (!line) return;
    requests.push_back(
        {name, kind, {{line->chip, line->line}, line->active_low, safe_level(kind, line->safe)}});
  };
  add("map_ready", OutputKind::kMapReady, gpio.map_ready);
  add("fault", OutputKind::kFault, gpio.fault);
  add("heartbeat", OutputKind::kHeartbeat, gpio.heartbeat);
  return requests;
}

std::vector<InputRequest> input_requests(const GpioSettings& gpio) {
  std::vector<InputRequest> requests;
  if (gpio.dock) requests.push_back({"dock", LineEdge::kDock, input_of(gpio.dock->input)});
  if (gpio.hold) requests.push_back({"hold", LineEdge::kHold, input_of(*gpio.hold)});
  std::uint32_t line = LineEdge::kFirstMarker;
  for (const GpioSettings::Marker& marker : gpio.markers) {
    requests.push_back({"zone_markers." + marker.name, line++, input_of(marker.input)});
  }
  return requests;
}

std::vector<LineFinding> inspect_lines(GpioPort& port, const GpioSettings& gpio) {
  std::vector<LineFinding> findings;
  for (const OutputRequest& request : output_requests(gpio)) {
    findings.push_back(inspect(port, request.name, request.settings.name, true));
  }
  for (const InputRequest& request : input_requests(gpio)) {
    findings.push_back(inspect(port, request.name, request.settings.name, false));
  }
  return findings;
}

std::vector<std::string> set_safe_outputs(GpioPort& port, const GpioSettings& gpio) {
  std::vector<std::string> faults;
  for (const OutputRequest& request : output_requests(gpio)) {
    const auto line = port.open(request.settings);
    if (line) continue;
    faults.push_back(line_fault(port, request.name, request.settings.name, line.error()));
  }
  return faults;
}

std::string line_fault(GpioPort& port, const std::string& name, const GpioLineName& line,
                       const Error& error) {
  return "gpio." + name + ": " + explain_gpio(port, line, error);
}

}  // namespace zonepack
