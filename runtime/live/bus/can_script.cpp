// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/bus/can_script.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "platform/base/nearest_word.hpp"
#include "runtime/settings/field.hpp"
#include "runtime/settings/odometry_section.hpp"
#include "runtime/settings/yaml_limits.hpp"
#include "runtime/settings/yaml_section.hpp"

namespace zonepack {
namespace {

using ActKind = SimFault::Kind;

constexpr std::size_t kLargestScript = 1 << 20;
constexpr std::pair<const char*, ActKind> kKinds[] = {
    {"bus_off", ActKind::kBusOff},    {"passive", ActKind::kPassive}, {"drop", ActKind::kDrop},
    {"overflow", ActKind::kOverflow}, {"delay", ActKind::kDelay},     {"noise", ActKind::kNoise},
    {"down", ActKind::kDown},         {"absent", ActKind::kAbsent}};

struct FaultText {
  std::string kind;
  double at_s = 0;
  double for_s = 0;
  std::uint32_t count = 0;
};

const Fields<CanScript>& script_fields() {
  static const Fields<CanScript> fields = {
      {"log", in<&CanScript::log>, 0, 0, "", ""},
      {"loops", in<&CanScript::loops>, 1, 1e6, "", ""},
      {"queue", in<&CanScript::queue>, 0, 1e6, "", ""},
  };
  return fields;
}

const Fields<SimWireSettings>& wire_fields() {
  static const Fields<SimWireSettings> fields = {
      {"bit_rate", in<&SimWireSettings::bit_rate>, 0, 1e6, "bit/s", ""},
      {"data_bit_rate", in<&SimWireSettings::data_bit_rate>, 0, 1e7, "bit/s", ""},
  };
  return fields;
}

const Fields<DriveSettings>& drive_fields() {
  static const Fields<DriveSettings> fields = {
      {"period", in<&DriveSettings::period_s>, 0.0001, 10, "s", ""},
  };
  return fields;
}

const Fields<DriveLeg>& leg_fields() {
  static const Fields<DriveLeg> fields = {
      {"for", in<&DriveLeg::for_s>, 0.001, 1e6, "s", ""},
      {"speed", in<&DriveLeg::speed_m_s>, -20, 20, "m/s", ""},
      {"yaw_rate", in<&DriveLeg::yaw_rate_rad_s>, -20, 20, "rad/s", ""},
  };
  return fields;
}

const Fields<ScriptTraffic>& traffic_fields() {
  static const Fields<ScriptTraffic> fields = {
      {"id", in<&ScriptTraffic::id>, 0, 0x1FFFFFFF, "", ""},
      {"extended", in<&ScriptTraffic::extended>, 0, 0, "", ""},
      {"period", in<&ScriptTraffic::period_s>, 0.00001, 1000, "s", ""},
      {"length", in<&ScriptTraffic::length>, 0, 8, "bytes", ""},
  };
  return fields;
}

const Fields<FaultText>& fault_fields() {
  static const Fields<FaultText> fields = {
      {"kind", in<&FaultText::kind>, 0, 0, "", ""},
      {"at", in<&FaultText::at_s>, 0, 1e7, "s", ""},
      {"for", in<&FaultText::for_s>, 0, 1e7, "s", ""},
      {"count", in<&FaultText::count>, 0, 1e9, "frames", ""},
  };
  return fields;
}

// Calls `read` with a section for each entry of a list, which may be absent.
template <typename Read>
void each(YamlSection& parent, const char* key, FaultList& faults, Read read) {
  const YAML::Node list = parent.take(key);
  if (!list.IsDefined()) return;
  if (!list.IsSequence()) {
    faults.add(list.Mark(), parent.path_of(key), "expected a list");
    return;
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    YamlSection entry(list[i], parent.path_of(key) + "[" + std::to_string(i) + "]", faults);
    read(entry);
    entry.finish();
  }
}

void read_fault(YamlSection& entry, FaultList& faults, std::vector<SimFault>& into) {
  FaultText text;
  entry.read(fault_fields(), text);
  const auto kind = std::find_if(std::begin(kKinds), std::end(kKinds),
                                 [&](const auto& known) { return text.kind == known.first; });
  if (kind == std::end(kKinds)) {
    std::vector<std::string> known;
    for (const auto& [word, unused] : kKinds) known.emplace_back(word);
    faults.add(entry.mark_of("kind"), entry.path_of("kind"),
               "no such fault" + known_words_text(text.kind, known));
    return;
  }
  const bool counts = kind->second == ActKind::kDrop || kind->second == ActKind::kOverflow;
  if ((text.for_s > 0) == (text.count > 0) || (text.count > 0 && !counts)) {
    faults.add(
        entry.mark(), entry.path_of("for"),
        counts ? "give either for (s) or count (frames)" : "give how long, for (s), and no count");
  }
  into.push_back({kind->second, static_cast<std::int64_t>(text.at_s * 1e9),
                  static_cast<std::int64_t>(text.for_s * 1e9), text.count});
}

void read_drive(YamlSection& file, FaultList& faults, CanScript& script) {
  YamlSection drive(file.take("drive"), "drive", faults);
  drive.read(drive_fields(), script.drive);
  each(drive, "legs", faults, [&](YamlSection& entry) {
    DriveLeg leg;
    entry.read(leg_fields(), leg);
    script.drive.legs.push_back(leg);
  });
  drive.finish();
  if (script.drive.legs.empty())
    faults.add(drive.mark(), "drive.legs", "expected at least one leg");
}

void read_script(const YAML::Node& root, const std::string& path, CanScript& script,
                 FaultList& faults) {
  YamlSection file(root, "", faults);
  file.read(script_fields(), script);
  file.read(wire_fields(), script.wire);
  if (file.has("drive") == file.has("log")) {
    faults.add(file.mark(), "", "give either log, a candump log, or drive");
  }
  if (file.has("drive")) read_drive(file, faults, script);
  each(file, "traffic", faults, [&](YamlSection& entry) {
    ScriptTraffic traffic;
    entry.read(traffic_fields(), traffic);
    if (!traffic.extended && traffic.id > 0x7FF) {
      faults.add(entry.mark_of("id"), entry.path_of("id"), "over 0x7FF needs extended: true");
    }
    script.traffic.push_back(traffic);
  });
  each(file, "faults", faults,
       [&](YamlSection& entry) { read_fault(entry, faults, script.wire.faults); });
  file.finish();
  script.drive.loops = script.loops;
  if (!script.log.empty()) script.log = beside(path, script.log);
}

}  // namespace

LoadedCanScript parse_can_script(const std::string& text, const std::string& path) {
  LoadedCanScript loaded;
  FaultList faults(path);
  try {
    if (fits_yaml_limits(text, faults)) {
      read_script(YAML::Load(text), path, loaded.script, faults);
    }
  } catch (const YAML::Exception& error) {
    faults.add(error.mark, "", "not YAML: " + error.msg);
  }
  loaded.faults = faults.take();
  return loaded;
}

LoadedCanScript load_can_script(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  if (!file || !text || text.str().empty() || text.str().size() > kLargestScript) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "empty, over 1 MiB or no file";
    return {{}, {path + ": cannot be read: " + reason + "; expected a script (YAML) of a CAN bus"}};
  }
  return parse_can_script(text.str(), path);
}

}  // namespace zonepack
