// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <string>
#include <string_view>

#include "runtime/settings/field.hpp"
#include "runtime/settings/yaml_value.hpp"

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

// "1,000,000", "0.000001": a number as a person writes it.
std::string plain_text(double value) {
  char digits[32];
  const auto [end, error] =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed);
  std::string text(digits, end);
  if (std::abs(value) < 10'000) return text;
  const std::size_t first = text[0] == '-' ? 1 : 0;
  for (std::size_t at = text.find_first_of('.') == text.npos ? text.size() : text.find('.');
       at > first + 3;) {
    text.insert(at -= 3, ",");
  }
  return text;
}

// "64 MiB" of bytes, "50 MB/s" of bytes/s; nothing of what is no whole number of a larger unit.
std::string size_text(double value, std::string_view unit) {
  const bool rate = unit == "bytes/s";
  if ((!rate && unit != "bytes") || value == 0) return {};
  const double step = rate ? 1000 : 1024;
  const char* const names[] = {"", rate ? "kB/s" : "KiB", rate ? "MB/s" : "MiB",
                               rate ? "GB/s" : "GiB", rate ? "TB/s" : "TiB"};
  std::size_t name = 0;
  while (name + 1 < std::size(names) && std::fmod(value, step) == 0) value /= step, ++name;
  return name == 0 ? std::string() : plain_text(value) + " " + names[name];
}

// CAN ids are hexadecimal in every manual.
bool is_can_id(std::string_view key) { return key == "id" || key.ends_with("_id"); }

std::string hexadecimal(double value) {
  if (value < 10) return plain_text(value);
  char digits[16];
  std::snprintf(digits, sizeof digits, "0x%X", static_cast<unsigned>(value));
  return digits;
}

std::string bound(const char* key, const FieldLimits& limits, double value) {
  if (is_can_id(key)) return hexadecimal(value);
  const std::string size = size_text(value, limits.unit);
  return size.empty() ? plain_text(value) : size;
}

std::string range_text(const char* key, const FieldLimits& limits) {
  const std::string unit = limits.unit;
  const bool sized = !size_text(limits.most, unit).empty();
  std::string text;
  if (limits.most < kNoMost) {
    text = bound(key, limits, limits.least) + " to " + bound(key, limits, limits.most);
  } else if (limits.least <= -kNoMost) {
    return "any number";
  } else {
    text = bound(key, limits, limits.least) + " or more";
  }
  return unit.empty() || (sized && limits.most < kNoMost) ? text : text + " " + unit;
}

// Defaults stand as a settings file takes them. One that is not allowed stands for none.
std::string default_text(const char* key, const FieldLimits& limits, double value) {
  if (value < limits.least || value > limits.most) return "required";
  if (is_can_id(key)) return hexadecimal(value);
  const std::string size = size_text(value, limits.unit);
  return number_text(value) + (size.empty() ? "" : " (" + size + ")");
}

// "ALLOWED | DEFAULT" of a value that has its default, by kind.
struct ValueDescription {
  const char* key;
  const FieldLimits& limits;

  std::string number(double value) const {
    return range_text(key, limits) + " | " + default_text(key, limits, value);
  }
  std::string operator()(const double* value) const { return number(*value); }
  std::string operator()(const std::uint32_t* value) const { return number(*value); }
  std::string operator()(const std::uint64_t* value) const {
    return number(static_cast<double>(*value));
  }
  std::string operator()(const bool* value) const {
    return std::string("true, false | ") + (*value ? "true" : "false");
  }
  std::string operator()(const std::string* value) const {
    return "text | " + (value->empty() ? "-" : *value);
  }
  std::string operator()(const std::vector<std::string>*) const { return "list of texts | []"; }
  std::string operator()(const std::optional<ByteCount>*) const {
    return "bytes, or a number with KiB, MiB, GiB or K, M, G: 6.8MiB; or kB, MB, GB (of 1000) | "
           "the smallest that the map allows; with max_signatures, the whole map; refused beyond "
           "a quarter of the computer's memory, and printed";
  }
  std::string operator()(const PayloadChoice* value) const {
    return "list of " + payload_words(kEveryPayload) + " | [" + payload_words(value->mask) + "]";
  }
  template <typename Enum>
  std::string operator()(const Enum* value) const {
    return words_of<Enum>() + " | " + EnumWords<Enum>::kWords[static_cast<std::size_t>(*value)];
  }
};

std::string row(const char* key, const FieldLimits& limits, const FieldValue& value,
                const char* meaning) {
  return std::string("| ") + key + " | " + std::visit(ValueDescription{key, limits}, value) +
         " | " + meaning + " |\n";
}

template <typename Section>
std::string rows(const Fields<Section>& fields) {
  Section defaults{};
  std::string text;
  for (const Field<Section>& field : fields) {
    text += row(field.key, field.limits(), field.value(defaults), field.meaning);
  }
  return text;
}

// A section's heading, and a sentence on what it is for.
std::string head(const std::string& section, const std::string& purpose = "") {
  return "\n## " + section + "\n" + (purpose.empty() ? "" : purpose + "\n\n") +
         "| key | allowed | default | meaning |\n|---|---|---|---|\n";
}

constexpr const char* kIntroduction =
    "# Settings\n"
    "One YAML file holds the settings of a robot; `agilex.yaml` is an example with comments. This\n"
    "page is what the program itself says about its keys, and a test keeps the two equal.\n"
    "\n"
    "Reading is strict. A key that is not listed here, appears twice, has the wrong type or is "
    "out\n"
    "of range is refused with the file, the line and what is allowed; all faults are reported at\n"
    "once. A key that is absent has its default; a default of - is an empty text. The paths\n"
    "`map.path`, `can.dbc` and `state.folder` are relative to the settings file. Where a meaning\n"
    "ends in an option, such as `--budget`, that option of `zoned` replaces the key. \"Sigma\" is "
    "a\n"
    "standard deviation; \"three sigma\" is that of the pose. A file has at most 1 MiB, and 20000\n"
    "keys and values; of its faults the first 200 are listed.\n";

constexpr const char* kCanRows =
    "| signals | signals by name | none | what the frames hold; see below |\n"
    "| canopen | see below | none | CANopen drives |\n";

constexpr const char* kGpioRows =
    "| map_ready | an output | none | active while the pose is trusted and the robot's zone is in "
    "memory, so motion may go on; valid only while heartbeat toggles |\n"
    "| fault | an output | none | active while control cycles have stopped, odometry is missing, "
    "or a zone that is needed is not in memory |\n"
    "| heartbeat | an output | none | toggles, for an external watchdog |\n"
    "| dock | an input | none | a contact at a known pose: the pose is reset to it and trusted |\n"
    "| hold | an input | none | while active, nothing is evicted |\n"
    "| zone_markers | inputs by name | none | doors or beacons that confirm a change of zone |\n";

}  // namespace

std::string settings_reference() {
  return kIntroduction + head("map", "Which map the robot uses.") + rows(map_fields()) +
         head("memory", "What is kept in memory, and how much of it.") + rows(memory_fields()) +
         head("loading",
              "How packs are read, and how long a load is taken to last. The two rates decide how "
              "early a\nzone is asked for, and are the whole model of the disk in `zoned replay`. "
              "Rates "
              "are in bytes per\nsecond.") +
         rows(loading_fields()) + head("can", "The bus and the signals on it.") +
         rows(can_fields()) + kCanRows +
         head("can.signals.NAME", "One signal of a frame, without a DBC file.") +
         rows(signal_fields()) +
         "| multiplexer | see below | none | bits that say whether the signal is present |\n" +
         head("can.signals.NAME.multiplexer") + rows(multiplex_fields()) +
         head("can.canopen", "Drives that announce their state by heartbeat, or sample on SYNC.") +
         rows(canopen_fields()) + "| nodes | nodes by name | none | see below |\n" +
         head("can.canopen.nodes.NAME") + rows(canopen_node_fields()) +
         head("odometry", "How signals become motion, and how far that motion is trusted.") +
         rows(wheel_fields()) + rows(geometry_fields()) + rows(odometry_fields()) +
         head("pose", "How fixes from a localizer and odometry become one pose.") +
         rows(pose_fields()) + head("zones", "When the robot counts as being in another zone.") +
         rows(zones_fields()) + head("preload", "When the zone behind a portal is asked for.") +
         rows(preload_fields()) + head("cycle", "The control cycle.") + rows(cycle_fields()) +
         head("realtime", "What `zoned run` asks of the kernel.") + rows(realtime_fields()) +
         head("recorder", "The flight recorder of `zoned run`.") + rows(recorder_fields()) +
         head("state", "What survives a restart of `zoned run`.") + rows(state_fields()) +
         head("serve", "The socket for `zonectl`, localizers and readers of the map.") +
         rows(serve_fields()) +
         head("gpio", "Lines to the robot's safety circuit, and contacts. None by default.") +
         rows(gpio_fields()) + kGpioRows +
         head("gpio.map_ready, gpio.fault, gpio.heartbeat", "Keys of every output.") +
         rows(output_line_fields()) +
         head("gpio.dock, gpio.hold, gpio.zone_markers.NAME", "Keys of every input.") +
         rows(input_line_fields()) + head("gpio.dock", "Further keys of this input.") +
         rows(dock_fields()) + head("gpio.zone_markers.NAME", "Further keys of these inputs.") +
         rows(marker_fields());
}

}  // namespace zonepack
