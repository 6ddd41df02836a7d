// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/odometry_section.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "platform/base/nearest_word.hpp"
#include "runtime/settings/canopen_section.hpp"
#include "runtime/settings/dbc_file.hpp"
#include "runtime/settings/dbc_unit.hpp"
#include "runtime/settings/field.hpp"
#include "runtime/settings/odometry_units.hpp"

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

// Signals by the names that the settings use: those of can.signals, then those of the DBC file.
class SignalNames {
 public:
  SignalNames(CanSettings& can, FaultList& faults) : can_(can), faults_(faults) {}

  void load() {
    LoadedDbc loaded =
        can_.dbc_text.empty() ? load_dbc(can_.dbc) : parse_dbc(can_.dbc_text, can_.dbc);
    if (can_.dbc_text.empty()) can_.dbc_text = std::move(loaded.text);
    for (const std::string& fault : loaded.faults) faults_.add_complete(fault);
    for (const std::string& slip : loaded.slips) faults_.add_warning(slip + "; left out");
    dbc_broken_ = !loaded.ok();
    if (!loaded.slips.empty()) first_slip_ = "; what could not be read: " + loaded.slips.front();
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

  // The unit of a signal of the DBC file as it is written there; empty for any other name.
  std::string unit_of(const std::string& name) const {
    if (dbc_broken_ || can_.dbc.empty() || name.find('.') == std::string::npos) return {};
    // Signals of the DBC file are added to can_.signals once they are resolved.
    if (can_.signals.count(name) != 0 && from_dbc_.count(name) == 0) return {};
    const Outcome<DbcFound> found = dbc_.find(name);
    return found ? found->unit : std::string();
  }

  // The longest GenMsgCycleTime of the messages asked for so far; 0 when none has one.
  double longest_cycle_s() const noexcept { return longest_cycle_s_; }

 private:
  void from_dbc(const YamlSection& section, const char* key, const std::string& name,
                CanSignal& signal) {
    if (dbc_broken_) return;
    const Outcome<DbcFound> found = dbc_.find(name);
    if (!found) {
      faults_.add(section.mark_of(key), section.path_of(key), found.error().message + first_slip_);
      return;
    }
    longest_cycle_s_ = std::max(longest_cycle_s_, found->cycle_s.value_or(0));
    signal = found->signal;
    can_.signals.emplace(name, signal);
    from_dbc_.insert(name);
  }

  CanSettings& can_;
  FaultList& faults_;
  DbcFile dbc_;
  bool dbc_broken_ = false;
  std::set<std::string> from_dbc_;
  std::string first_slip_;  // added to messages about signals that are not found
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
  read_canopen(section, can, faults);
  section.finish();
  if (can.dbc.empty()) return;
  can.dbc = beside(path, can.dbc);
  names.load();
}

// A message comes once per its cycle time; two may be lost, and only a control cycle notices the
// timeout.
void time_out_by_cycle(double longest_cycle_s, double period_hz, double& timeout_s) {
  constexpr double kCycles = 3;
  constexpr double kLeast_s = 0.01;
  constexpr double kMost_s = 60;
  if (longest_cycle_s <= 0) return;
  timeout_s = std::clamp(std::max(kCycles * longest_cycle_s, 2 / period_hz), kLeast_s, kMost_s);
}

bool is_left(const std::string& key) { return key.ends_with("left"); }
bool is_right(const std::string& key) { return key.ends_with("right"); }

// Reports keys that contradict each other.
void check_units(const YamlSection& section, const OdometrySettings& odometry,
                 const std::vector<SignalKey>& keys, FaultList& faults) {
  const auto add = [&](const char* key, const std::string& text) {
    faults.add(section.mark_of(key), section.path_of(key), text);
  };
  const WheelUnit unit = odometry.unit;
  if ((unit == WheelUnit::kRpm || unit == WheelUnit::kErpm) &&
      reads_positions(odometry.wheels.model)) {
    add("unit",
        "rpm and erpm are speeds, and the model reads positions; allowed: metres, radians, "
        "turns, ticks, or a model that ends with -speeds");
  }
  if (unit == WheelUnit::kTicks && odometry.ticks_per_turn <= 0) {
    add("ticks_per_turn", "missing; unit: ticks needs it");
  }
  if (unit == WheelUnit::kKilometresPerHour && reads_positions(odometry.wheels.model)) {
    add("unit", "km/h is a speed, and the model reads positions; allowed: metres, mm");
  }
  if (is_length(unit) && odometry.gear != 1) {
    add("gear", "has no meaning for metres; leave it out, or give the unit of the motor's signals");
  }
  const bool sides = !keys.empty() && is_left(keys[0].key);
  const char* const no_sides = "the model has no left and right side; use scale";
  if (odometry.scale_left != 1 && !sides) add("scale_left", no_sides);
  if (odometry.scale_right != 1 && !sides) add("scale_right", no_sides);
  for (const std::string& word : odometry.invert) {
    if (std::any_of(keys.begin(), keys.end(), [&](const auto& k) { return k.key == word; }))
      continue;
    std::vector<std::string> known;
    known.reserve(keys.size());
    for (const SignalKey& key : keys) known.push_back(key.key);
    add("invert", "\"" + word + "\" is no signal of this model" + known_words_text(word, known));
  }
}

// Without the key `unit`, the unit of the first wheel in the DBC file decides.
void adopt_dbc_unit(const YamlSection& section, const std::string& text, OdometrySettings& odometry,
                    FaultList& faults) {
  const DbcUnit unit = parse_dbc_unit(text);
  if (section.has("unit")) return;
  if (unit.kind == DbcUnit::Kind::kTicks) {
    faults.add(section.mark(), section.path_of("unit"),
               "missing; the DBC file counts in \"" + text +
                   "\": give unit: ticks, ticks_per_turn and wheel_radius");
    odometry.unit = WheelUnit::kTicks;
    odometry.ticks_per_turn = 1;
  }
  if (unit.kind != DbcUnit::Kind::kAngle) return;
  odometry.unit = WheelUnit::kRadians;
  for (const WheelUnit same : {WheelUnit::kTurns, WheelUnit::kDegrees}) {
    if (!unit.per_time && unit.si == as_dbc_unit(same).si) odometry.unit = same;
  }
  if (unit.per_time && unit.si == as_dbc_unit(WheelUnit::kRpm).si) odometry.unit = WheelUnit::kRpm;
  if (!section.has("wheel_radius")) {
    faults.add(section.mark(), section.path_of("wheel_radius"),
               "missing; the DBC file gives \"" + text + "\", which becomes a way only with it");
  }
}

// The signals in the model's order, each with its sign, scale and unit.
void resolve_signals(const YamlSection& section, SignalNames& names, OdometrySettings& odometry,
                     FaultList& faults) {
  WheelOdometrySettings& wheels = odometry.wheels;
  const std::vector<SignalKey> keys = signal_keys(odometry);
  const bool omni =
      wheels.model == OdometryModel::kOmniPositions || wheels.model == OdometryModel::kOmniSpeeds;
  if (omni && keys.size() != 3 && keys.size() != 4) {
    faults.add(section.mark_of("around"), section.path_of("around"),
               "needs the signals of 3 or 4 wheels, has " + std::to_string(keys.size()));
    return;
  }
  const bool on_wheels = wheels.model != OdometryModel::kTwist;
  if (on_wheels && !keys.empty()) {
    adopt_dbc_unit(section, names.unit_of(keys[0].name), odometry, faults);
  }
  check_units(section, odometry, keys, faults);
  if (omni) wheels.geometry.omni_wheels = keys.size();
  const std::size_t rolling = WheelModel(wheels.model, wheels.geometry).wheels();
  const double metres = metres_per_unit(odometry);
  bool percent = false;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::string& key = keys[i].key;
    const char* const written = omni ? "around" : key.c_str();
    const std::string unit = names.unit_of(keys[i].name);
    percent = percent || is_percent(unit);
    names.resolve(section, written, keys[i].name, wheels.signals[i]);
    const auto converted =
        i < rolling ? wheel_conversion(odometry, unit) : si_of(odometry, key, unit);
    if (!converted) {
      faults.add(section.mark_of(written), section.path_of(written),
                 "\"" + keys[i].name + "\": " + converted.error().message);
    }
    double& scale = wheels.metres_per_unit[i];
    scale = (i < rolling ? metres : 1) * (converted ? *converted : 1);
    if (is_left(key)) scale *= odometry.scale_left;
    if (is_right(key)) scale *= odometry.scale_right;
    const auto& invert = odometry.invert;
    if (std::find(invert.begin(), invert.end(), key) != invert.end()) scale = -scale;
  }
  if (odometry.full_scale > 0 && !percent) {
    faults.add(section.mark_of("full_scale"), section.path_of("full_scale"),
               "has no effect: the DBC file gives none of these signals in %; leave it out");
  }
}

}  // namespace

std::vector<SignalKey> signal_keys(const OdometrySettings& odometry) {
  const OdometrySettings& o = odometry;
  switch (o.wheels.model) {
    case OdometryModel::kDifferentialPositions:
    case OdometryModel::kWheelSpeeds:
      return {{"left", o.left}, {"right", o.right}};
    case OdometryModel::kTwist:
      return {{"forward", o.forward}, {"yaw_rate", o.yaw_rate}};
    case OdometryModel::kAckermannPositions:
    case OdometryModel::kAckermannSpeeds:
      return {{"forward", o.forward}, {"steering", o.steering}};
    case OdometryModel::kMecanumPositions:
    case OdometryModel::kMecanumSpeeds:
      return {{"front_left", o.front_left},
              {"front_right", o.front_right},
              {"rear_left", o.rear_left},
              {"rear_right", o.rear_right}};
    case OdometryModel::kOmniPositions:
    case OdometryModel::kOmniSpeeds:
      break;
  }
  std::vector<SignalKey> keys;
  for (const std::string& name : o.around) keys.push_back({std::to_string(keys.size() + 1), name});
  return keys;
}

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
  section.read(geometry_fields(), odometry.wheels.geometry);
  section.finish();
  resolve_signals(section, names, odometry, faults);
  odometry.wheels.canopen = settings.can.canopen;
  if (!section.has("timeout")) {
    time_out_by_cycle(names.longest_cycle_s(), settings.cycle.period_hz, odometry.wheels.timeout_s);
  }
}

}  // namespace zonepack
