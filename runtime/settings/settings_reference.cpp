// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "runtime/settings/field.hpp"
#include "runtime/settings/yaml_section.hpp"

namespace zonepack {
namespace {

template <typename Enum>
std::string words_of() {
  std::string words;
  for (const char* word : EnumWords<Enum>::kWords) {
    words += (words.empty() ? "" : ", ") + std::string(word);
  }
  return words;
}

// Allowed values and the default, by kind.
struct FieldKind {
  double least, most;
  const char* unit;

  std::string allowed(double) const { return allowed_text(least, most, unit); }
  std::string allowed(std::uint32_t) const { return allowed_text(least, most, unit); }
  std::string allowed(std::uint64_t) const { return allowed_text(least, most, unit); }
  std::string allowed(bool) const { return "true, false"; }
  std::string allowed(const std::string&) const { return "text"; }
  std::string allowed(const std::vector<std::string>&) const { return "list of texts"; }
  std::string allowed(const std::optional<ByteCount>&) const { return "SIZE (24MiB)"; }
  std::string allowed(const PayloadChoice&) const {
    return "list of " + payload_words(kEveryPayload);
  }
  template <typename Enum>
  std::string allowed(Enum) const {
    return words_of<Enum>();
  }

  // A default out of range means that there is none.
  template <typename Number>
  std::string number(Number value) const {
    const auto real = static_cast<double>(value);
    return real < least || real > most ? "needed" : number_text(real);
  }
  std::string shown(double value) const { return number(value); }
  std::string shown(std::uint32_t value) const { return number(value); }
  std::string shown(std::uint64_t value) const { return number(value); }
  static std::string shown(bool value) { return value ? "true" : "false"; }
  static std::string shown(const std::string& value) { return value.empty() ? "-" : value; }
  static std::string shown(const std::vector<std::string>&) { return "[]"; }
  static std::string shown(const std::optional<ByteCount>&) {
    return "the map's smallest; the whole map beside max_signatures";
  }
  static std::string shown(const PayloadChoice& value) {
    return "[" + payload_words(value.mask) + "]";
  }
  template <typename Enum>
  static std::string shown(Enum value) {
    return EnumWords<Enum>::kWords[static_cast<std::size_t>(value)];
  }
};

template <typename Section>
std::string rows(const Fields<Section>& fields) {
  const Section defaults{};
  std::string text;
  for (const Field<Section>& field : fields) {
    const FieldKind kind{field.least, field.most, field.unit};
    std::visit(
        [&](auto member) {
          text += "| " + std::string(field.key) + " | " + kind.allowed(defaults.*member) + " | " +
                  kind.shown(defaults.*member) + " | " + field.meaning + " |\n";
        },
        field.member);
  }
  return text;
}

std::string head(const char* section) {
  return "\n## " + std::string(section) +
         "\n| key | allowed | default | meaning |\n|---|---|---|---|\n";
}

}  // namespace

std::string settings_reference() {
  return "# Settings\n"
         "One YAML file; `agilex.yaml` is a commented example. Reading is strict: a key that is "
         "not listed\n"
         "here, stands twice, has the wrong type or is out of range is refused with file, line and "
         "what is\n"
         "allowed, all faults at once. Keys that are absent have their default. A relative "
         "map.path, can.dbc\n"
         "or state.folder is relative to the settings file.\n" +
         head("map") + rows(map_fields()) + head("memory") + rows(memory_fields()) +
         head("loading") + rows(loading_fields()) + head("can") + rows(can_fields()) +
         "| signals | signals by name | none | what frames hold; see below |\n"
         "| canopen | see below | none | CANopen drives |\n" +
         head("can.signals.NAME") + rows(signal_fields()) +
         "| multiplexer | see below | none | bits that tell whether the signal is there |\n" +
         head("can.signals.NAME.multiplexer") + rows(multiplex_fields()) + head("can.canopen") +
         rows(canopen_fields()) + "| nodes | nodes by name | none | see below |\n" +
         head("can.canopen.nodes.NAME") + rows(canopen_node_fields()) + head("odometry") +
         rows(wheel_fields()) + rows(geometry_fields()) + rows(odometry_fields()) + head("pose") +
         rows(pose_fields()) + head("zones") + rows(zones_fields()) + head("preload") +
         rows(preload_fields()) + head("cycle") + rows(cycle_fields()) + head("realtime") +
         rows(realtime_fields()) + head("recorder") + rows(recorder_fields()) + head("state") +
         rows(state_fields()) + head("serve") + rows(serve_fields()) + head("gpio") +
         rows(gpio_fields()) +
         "| map_ready | an output | none | active while the pose is trusted and the robot's zone "
         "in "
         "memory: motion may go on. Valid only while heartbeat toggles |\n"
         "| fault | an output | none | active while control cycles stand, odometry is missing, or "
         "a "
         "zone that is needed is not in memory |\n"
         "| heartbeat | an output | none | toggles: for an external watchdog |\n"
         "| dock | an input | none | a contact at a known pose: the pose is reset to it, and "
         "trusted |\n"
         "| hold | an input | none | while active nothing is evicted |\n"
         "| zone_markers | inputs by name | none | doors or beacons that confirm a change of zone "
         "|\n" +
         head("gpio.map_ready, gpio.fault, gpio.heartbeat") + rows(output_line_fields()) +
         head("gpio.dock, gpio.hold, gpio.zone_markers.NAME") + rows(input_line_fields()) +
         head("gpio.dock") + rows(dock_fields()) + head("gpio.zone_markers.NAME") +
         rows(marker_fields());
}

}  // namespace zonepack
