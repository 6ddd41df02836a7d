// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/gpio_section.hpp"

#include <map>

#include "runtime/control/line_edge.hpp"
#include "runtime/settings/field.hpp"

namespace zonepack {
namespace {

// Reads lines, and reports those that have no name or share one.
class LineReader {
 public:
  LineReader(YamlSection& gpio, FaultList& faults) : gpio_(gpio), faults_(faults) {}

  void read(const char* key, std::optional<OutputLine>& into) {
    const YAML::Node node = gpio_.take(key);
    if (!node.IsDefined()) return;
    YamlSection section(node, gpio_.path_of(key), faults_);
    section.read(output_line_fields(), into.emplace());
    section.finish();
    check(section, into->chip, into->line);
  }

  void read(const char* key, std::optional<InputLine>& into) {
    const YAML::Node node = gpio_.take(key);
    if (!node.IsDefined()) return;
    YamlSection section(node, gpio_.path_of(key), faults_);
    read_input(section, into.emplace());
    section.finish();
  }

  void read_dock(std::optional<GpioSettings::Dock>& into) {
    const YAML::Node node = gpio_.take("dock");
    if (!node.IsDefined()) return;
    YamlSection section(node, "gpio.dock", faults_);
    read_input(section, into.emplace().input);
    section.read(dock_fields(), into->place);
    for (const char* key : {"x", "y", "yaw"}) {
      if (section.has(key)) continue;
      faults_.add(section.mark(), section.path_of(key),
                  "missing; where base_link stands in the map when the contact closes");
    }
    section.finish();
  }

  void read_marker(const std::string& name, const YAML::Node& node, GpioSettings& gpio) {
    YamlSection section(node, "gpio.zone_markers." + name, faults_);
    GpioSettings::Marker& marker = gpio.markers.emplace_back();
    marker.name = name;
    read_input(section, marker.input);
    section.read(marker_fields(), marker.place);
    section.finish();
    const std::vector<std::string>& zones = marker.place.zones;
    const bool beacon = zones.size() == 1;
    const bool door = zones.size() == 2 && zones[0] != zones[1];
    if (beacon || door) return;
    faults_.add(section.mark_of("zones"), section.path_of("zones"),
                "expected the two zones of a door [A, B], or the one that a beacon lies in [A]");
  }

 private:
  void read_input(YamlSection& section, InputLine& into) {
    section.read(input_line_fields(), into);
    check(section, into.chip, into.line);
  }

  void check(const YamlSection& section, const std::string& chip, const std::string& line) {
    if (chip.empty()) {
      faults_.add(section.mark(), section.path_of("chip"),
                  "missing; a chip's label, gpiochip0 or /dev/gpiochip0 (gpiodetect lists them)");
    }
    if (line.empty()) {
      faults_.add(section.mark(), section.path_of("line"),
                  "missing; a line's number or name (gpioinfo lists them)");
    }
    const std::string path = section.path_of("");
    const auto [at, added] = named_.emplace(std::pair(chip, line), path);
    if (added || chip.empty() || line.empty()) return;
    faults_.add(section.mark_of("line"), section.path_of("line"),
                "line " + line + " of chip " + chip + " is named twice, first at " +
                    at->second.substr(0, at->second.size() - 1));
  }

  YamlSection& gpio_;
  FaultList& faults_;
  std::map<std::pair<std::string, std::string>, std::string> named_;
};

}  // namespace

void read_gpio(YamlSection& file, GpioSettings& gpio, FaultList& faults) {
  YamlSection section(file.take("gpio"), "gpio", faults);
  section.read(gpio_fields(), gpio);
  LineReader lines(section, faults);
  lines.read("map_ready", gpio.map_ready);
  lines.read("fault", gpio.fault);
  lines.read("heartbeat", gpio.heartbeat);
  lines.read_dock(gpio.dock);
  lines.read("hold", gpio.hold);
  const YamlSection markers(section.take("zone_markers"), "gpio.zone_markers", faults);
  for (const auto& [name, node] : markers.entries()) lines.read_marker(name, node, gpio);
  if (gpio.markers.size() > LineEdge::kMostMarkers) {
    faults.add(section.mark_of("zone_markers"), "gpio.zone_markers",
               "at most " + std::to_string(LineEdge::kMostMarkers) + " markers");
  }
  section.finish();
}

}  // namespace zonepack
