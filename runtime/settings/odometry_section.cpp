// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/odometry_section.hpp"

#include <algorithm>
#include <filesystem>

#include "runtime/odometry/det_math.hpp"
#include "runtime/settings/dbc_file.hpp"
#include "runtime/settings/field.hpp"
#include "runtime/settings/nearest_word.hpp"

namespace zonepack {
namespace {

void read_signal_entry(const std::string& name, const YAML::Node& node, FaultList& faults,
                       std::map<std::string, CanSignal>& signals) {
  const std::size_t faults_before = faults.size();
  YamlSection section(node, "can.signals." + name, faults);
  SignalText text;
  section.read(signal_fields(), text);
  CanSignal signal;
  signal.id = text.id;
  signal.extended = text.extended;
  signal.bits = {static_cast<std::uint16_t>(text.start), static_cast<std::uint16_t>(text.length),
                 text.byte_order};
  signal.type = text.type;
  signal.factor = text.factor;
  signal.offset = text.offset;
  if (const YAML::Node multiplexer = section.take("multiplexer"); multiplexer.IsDefined()) {
    YamlSection inner(multiplexer, section.path_of("multiplexer"), faults);
    MultiplexText mux;
    inner.read(multiplex_fields(), mux);
    inner.finish();
    add_multiplexer(signal,
                    {static_cast<std::uint16_t>(mux.start), static_cast<std::uint16_t>(mux.length),
                     mux.byte_order},
                    {mux.value, mux.value});
  }
  section.finish();
  if (faults.size() == faults_before && !is_valid(signal)) {
    faults.add(
        section.mark(), "can.signals." + name,
        "no such signal fits a frame; needed: id (up to 0x7FF, with extended: true up to "
        "0x1FFFFFFF), length 1 to 64 (float 32, double 64) within 64 bytes from start, factor "
        "other than 0");
  }
  signals.emplace(name, signal);
}

// Signals by the names that stand in the settings: those of can.signals, then those of the DBC.
class SignalNames {
 public:
  SignalNames(CanSettings& can, FaultList& faults) : can_(can), faults_(faults) {}

  void load() {
    LoadedDbc loaded = load_dbc(can_.dbc);
    for (const std::string& fault : loaded.faults) faults_.add_complete(fault);
    dbc_broken_ = !loaded.ok();
    dbc_ = std::move(loaded.file);
  }

  // The signal that a key names; a fault when there is none.
  void resolve(const YamlSection& section, const char* key, const std::string& name,
               CanSignal& signal) {
    if (const auto written = can_.signals.find(name); written != can_.signals.end()) {
      signal = written->second;
      return;
    }
    if (name.find('.') != std::string::npos && !can_.dbc.empty()) {
      from_dbc(section, key, name, signal);
      return;
    }
    std::vector<std::string> known;
    for (const auto& [word, unused] : can_.signals) known.push_back(word);
    const std::string what = name.empty() ? std::string("missing; this model needs it")
                                          : "no signal \"" + name + "\" in can.signals";
    faults_.add(section.mark_of(key), section.path_of(key),
                what + (can_.dbc.empty() ? "" : "; a signal of can.dbc is named MESSAGE.SIGNAL") +
                    known_words_text(name, known));
  }

  // The longest GenMsgCycleTime of the messages asked for so far; 0 when none tells.
  double longest_cycle_s() const noexcept { return longest_cycle_s_; }

 private:
  void from_dbc(const YamlSection& section, const char* key, const std::string& name,
                CanSignal& signal) {
    if (dbc_broken_) return;
    std::string fault;
    const std::optional<DbcFound> found = dbc_.find(name, fault);
    if (!found) {
      faults_.add(section.mark_of(key), section.path_of(key), fault);
      return;
    }
    longest_cycle_s_ = std::max(longest_cycle_s_, found->cycle_s.value_or(0));
    signal = found->signal;
    can_.signals.emplace(name, signal);
  }

  CanSettings& can_;
  FaultList& faults_;
  DbcFile dbc_;
  bool dbc_broken_ = false;
  double longest_cycle_s_ = 0;
};

void read_can(YamlSection& file, const std::string& path, CanSettings& can, SignalNames& names,
              FaultList& faults) {
  YamlSection section(file.take("can"), "can", faults);
  section.read(can_fields(), can);
  const YamlSection signals(section.take("signals"), "can.signals", faults);
  for (const auto& [name, node] : signals.entries()) {
    read_signal_entry(name, node, faults, can.signals);
  }
  section.finish();
  if (can.dbc.empty()) return;
  can.dbc = beside(path, can.dbc);
  names.load();
}

// Frames come once a cycle; two may be lost, and the timeout is seen at the end of a control cycle.
void time_out_by_cycle(double longest_cycle_s, double period_hz, double& timeout_s) {
  constexpr double kCycles = 3;
  constexpr double kLeast_s = 0.01;
  constexpr double kMost_s = 60;
  if (longest_cycle_s <= 0) return;
  timeout_s = std::clamp(std::max(kCycles * longest_cycle_s, 2 / period_hz), kLeast_s, kMost_s);
}

}  // namespace

std::string beside(const std::string& path, const std::string& name) {
  return (std::filesystem::path(path).parent_path() / name).lexically_normal().string();
}

void read_odometry(YamlSection& file, const std::string& path, Settings& settings,
                   FaultList& faults) {
  SignalNames names(settings.can, faults);
  read_can(file, path, settings.can, names, faults);
  OdometrySettings& odometry = settings.odometry;
  YamlSection section(file.take("odometry"), "odometry", faults);
  section.read(odometry_fields(), odometry);
  section.read(wheel_fields(), odometry.wheels);
  section.finish();
  const bool twist = odometry.wheels.model == OdometryModel::kTwist;
  names.resolve(section, twist ? "forward" : "left", twist ? odometry.forward : odometry.left,
                odometry.wheels.left);
  names.resolve(section, twist ? "yaw_rate" : "right", twist ? odometry.yaw_rate : odometry.right,
                odometry.wheels.right);
  if (!section.has("timeout")) {
    time_out_by_cycle(names.longest_cycle_s(), settings.cycle.period_hz, odometry.wheels.timeout_s);
  }
  double metres = odometry.scale;
  if (odometry.unit != WheelUnit::kMetres) metres *= odometry.wheel_radius_m;
  if (odometry.unit == WheelUnit::kTurns) metres *= 2 * kPi;
  odometry.wheels.metres_per_unit = metres;
}

}  // namespace zonepack
