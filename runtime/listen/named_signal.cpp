// SPDX-License-Identifier: Apache-2.0
#include "runtime/listen/named_signal.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "platform/base/utf8.hpp"
#include "runtime/settings/dbc_file.hpp"

namespace zonepack {
namespace {

const char* wheel_unit_text(WheelUnit unit, bool position) {
  switch (unit) {
    case WheelUnit::kMetres:
      return position ? "m" : "m/s";
    case WheelUnit::kRadians:
      return position ? "rad" : "rad/s";
    case WheelUnit::kTurns:
      return position ? "turns" : "turns/s";
    case WheelUnit::kRpm:
      return "rpm";
    case WheelUnit::kErpm:
      return "erpm";
    case WheelUnit::kTicks:
      return position ? "ticks" : "ticks/s";
    case WheelUnit::kKilometresPerHour:
      return "km/h";
    case WheelUnit::kDegrees:
      return position ? "deg" : "deg/s";
    case WheelUnit::kMillimetres:
      break;
  }
  return position ? "mm" : "mm/s";
}

// The unit that the settings give to what is not a wheel.
std::string other_unit(const OdometrySettings& odometry, const std::string& key) {
  const bool degrees = odometry.angle_unit == AngleUnit::kDegrees;
  if (key == "steering") return degrees ? "deg" : "rad";
  if (key == "yaw_rate") return degrees ? "deg/s" : "rad/s";
  if (key != "forward") return "";
  return is_length(odometry.unit) ? wheel_unit_text(odometry.unit, false) : "m/s";
}

// What the DBC file says of a signal.
void describe(const DbcFile& dbc, NamedSignal& named) {
  const auto found = dbc.find(named.message + "." + named.name);
  if (!found) return;
  if (!found->unit.empty()) named.unit = found->unit;
  for (const DbcMessage& message : dbc.messages()) {
    if (message.id != named.signal.id || message.extended != named.signal.extended) continue;
    for (const DbcSignal& signal : message.signals) {
      if (!(signal.bits == named.signal.bits) || signal.least >= signal.most) continue;
      named.least = signal.least;
      named.most = signal.most;
    }
  }
}

// What odometry would refuse, as a range of the value.
void bound_by_limits(const WheelOdometrySettings& wheels, NamedSignal& named) {
  if (named.position || named.key == "steering" || named.key.empty()) return;
  const double arm = WheelModel(wheels.model, wheels.geometry).turn_arm_m();
  double most = wheels.max_speed_m_s;
  if (named.wheel) most += wheels.max_yaw_rate_rad_s * arm / 2;
  if (named.key == "yaw_rate") most = wheels.max_yaw_rate_rad_s;
  most /= std::abs(named.si_per_unit);
  named.least = -most;
  named.most = most;
}

NamedSignal named_by(const std::string& name, const CanSignal& signal) {
  NamedSignal named;
  const std::size_t dot = name.find('.');
  if (dot != std::string::npos) named.message = name.substr(0, dot);
  named.name = dot == std::string::npos ? name : name.substr(dot + 1);
  named.signal = signal;
  return named;
}

}  // namespace

std::vector<NamedSignal> named_signals(const Settings& settings) {
  const OdometrySettings& odometry = settings.odometry;
  const WheelOdometrySettings& wheels = odometry.wheels;
  const WheelModel model(wheels.model, wheels.geometry);
  LoadedDbc dbc;
  if (!settings.can.dbc.empty()) dbc = parse_dbc(settings.can.dbc_text, settings.can.dbc);
  std::vector<NamedSignal> all;
  std::set<std::string> listed;
  const auto keys = signal_keys(odometry);
  for (std::size_t i = 0; i < std::min(keys.size(), model.signals()); ++i) {
    NamedSignal named = named_by(keys[i].name, wheels.signals[i]);
    named.key = keys[i].key;
    named.wheel = i < model.wheels();
    named.position = named.wheel && reads_positions(wheels.model);
    named.si_per_unit = wheels.metres_per_unit[i];
    named.unit = named.wheel ? wheel_unit_text(odometry.unit, named.position)
                             : other_unit(odometry, named.key);
    bound_by_limits(wheels, named);
    describe(dbc.file, named);
    listed.insert(keys[i].name);
    all.push_back(std::move(named));
  }
  for (const auto& [name, signal] : settings.can.signals) {
    if (!listed.insert(name).second) continue;
    NamedSignal named = named_by(name, signal);
    if (name == odometry.forward) named.unit = "m/s";
    if (name == odometry.yaw_rate) named.unit = other_unit(odometry, "yaw_rate");
    describe(dbc.file, named);
    all.push_back(std::move(named));
  }
  return all;
}

std::map<MessageId, std::string> message_names(const Settings& settings) {
  std::map<MessageId, std::string> names;
  if (settings.can.dbc.empty()) return names;
  const LoadedDbc dbc = parse_dbc(settings.can.dbc_text, settings.can.dbc);
  for (const DbcMessage& message : dbc.file.messages()) {
    names.emplace(MessageId(message.id, message.extended), message.name);
  }
  return names;
}

std::string printable(std::string_view text) {
  std::string clean;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const auto first = static_cast<unsigned char>(text.front());
    if (length == 0 || first < 0x20 || first == 0x7F) {
      clean += '?';
      text.remove_prefix(1);
    } else {
      clean += text.substr(0, length);
      text.remove_prefix(length);
    }
  }
  return clean;
}

}  // namespace zonepack
