// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/wheel_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/settings/dbc_file.hpp"
#include "runtime/settings/dbc_unit.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kMostSpeeds = 1024;

// A signal that the settings name although the model does not read it, and its factor to SI units.
struct SpareSignal {
  std::optional<CanSignal> signal;
  double si = 1;
};

SpareSignal spare_signal(const CanSettings& can, const std::string& name, double si) {
  if (name.empty()) return {};
  if (const auto written = can.signals.find(name); written != can.signals.end()) {
    return {written->second, si};
  }
  if (can.dbc.empty() || name.find('.') == std::string::npos) return {};
  const LoadedDbc dbc = parse_dbc(can.dbc_text, can.dbc);
  const auto found = dbc.file.find(name);
  if (!dbc.ok() || !found) return {};
  const DbcUnit unit = parse_dbc_unit(found->unit);
  return {found->signal, unit.kind == DbcUnit::Kind::kNone ? si : unit.si};
}

std::vector<SignalTrace> traces_of(const WheelOdometrySettings& wheels) {
  const WheelModel model(wheels.model, wheels.geometry);
  std::vector<SignalTrace> traces;
  for (std::size_t i = 0; i < model.signals(); ++i) {
    traces.emplace_back(wheels.signals[i], reads_positions(wheels.model) && i < model.wheels());
  }
  return traces;
}

}  // namespace

WheelWatch::WheelWatch(const Settings& settings, Reference reference)
    : settings_(settings),
      reference_(std::move(reference)),
      half_track_m_(settings.odometry.wheels.geometry.track_m *
                    settings.odometry.wheels.geometry.slip_factor / 2),
      odometry_(settings.odometry.wheels),
      unlimited_(without_limits(settings.odometry.wheels)),
      traces_(traces_of(settings.odometry.wheels)) {
  const OdometrySettings& o = settings.odometry;
  if (!reference_.motion && has_sides(o.wheels.model)) {
    const double degrees = o.angle_unit == AngleUnit::kDegrees ? kDegree_rad : 1;
    const SpareSignal yaw = spare_signal(settings.can, o.yaw_rate, degrees);
    const SpareSignal forward = spare_signal(settings.can, o.forward, 1);
    const auto& inverted = o.invert;
    const auto sign = [&inverted](const char* key) {
      return std::find(inverted.begin(), inverted.end(), key) != inverted.end() ? -1 : 1;
    };
    if (yaw.signal && is_valid(*yaw.signal)) {
      yaw_rate_ = yaw.signal;
      yaw_factor_ = yaw.si * sign("yaw_rate");
      reference_.name = "odometry.yaw_rate (" + o.yaw_rate + ")";
      if (forward.signal && is_valid(*forward.signal)) {
        forward_ = forward.signal;
        forward_factor_ = forward.si * sign("forward");
        reference_.name = o.forward + " and " + o.yaw_rate;
      }
      reference_.motion = [this](std::int64_t from_ns, std::int64_t to_ns) {
        return twist_.between(from_ns, to_ns);
      };
    }
  }
  windows_ = DriveWindows(reference_.motion);
}

WheelStep WheelWatch::step_of(const OdometryIncrement& increment, bool known) const {
  const double seconds = static_cast<double>(increment.to_ns - increment.from_ns) * 1e-9;
  const double forward = increment.speed_m_s * seconds;
  const double turn = increment.yaw_rate_rad_s * seconds;
  return {increment.from_ns, increment.to_ns, forward - turn * half_track_m_,
          forward + turn * half_track_m_, known};
}

void WheelWatch::follow_without_limits(const CanFrame& frame) {
  const std::uint64_t breaks = unlimited_.counters().gaps + unlimited_.counters().rebased;
  const auto increment = unlimited_.take(frame);
  if (!increment || increment->to_ns <= increment->from_ns) return;
  const bool known = breaks == unlimited_.counters().gaps + unlimited_.counters().rebased;
  windows_.add(step_of(*increment, known));
  const double speed = std::abs(increment->speed_m_s);
  if (speed <= settings_.odometry.wheels.max_speed_m_s) return;
  if (fast_m_s_.size() < kMostSpeeds) fast_m_s_.push_back(speed);
  fast_m_s_[fast_seen_++ % kMostSpeeds] = speed;
}

std::optional<WheelStep> WheelWatch::take(const CanFrame& frame) {
  for (SignalTrace& trace : traces_) trace.take(frame);
  using Status = SignalReading::Status;
  if (forward_) {
    const SignalReading reading = read_signal(*forward_, frame);
    if (reading.status == Status::kValue) {
      twist_.add_forward(reading.value * forward_factor_);
    }
  }
  if (yaw_rate_) {
    const SignalReading reading = read_signal(*yaw_rate_, frame);
    if (reading.status == Status::kValue) {
      twist_.add_yaw_rate(frame.stamp_ns, reading.value * yaw_factor_);
    }
  }
  follow_without_limits(frame);
  const std::uint64_t breaks = odometry_.counters().gaps + odometry_.counters().rebased;
  const auto increment = odometry_.take(frame);
  if (!increment || increment->to_ns <= increment->from_ns) return std::nullopt;
  ++accepted_;
  increment_ = increment;
  return step_of(*increment, breaks == odometry_.counters().gaps + odometry_.counters().rebased);
}

WheelEvidence WheelWatch::evidence() const {
  WheelEvidence evidence;
  evidence.traces = traces_;
  evidence.windows = windows_.windows();
  evidence.reference = reference_.name;
  evidence.too_fast = odometry_.counters().too_fast;
  evidence.samples = accepted_ + odometry_.counters().rejected - odometry_.counters().unreadable -
                     odometry_.counters().unwatched;
  std::vector<double> fast = fast_m_s_;
  if (!fast.empty()) {
    const auto middle = fast.begin() + static_cast<std::ptrdiff_t>(fast.size() / 2);
    std::nth_element(fast.begin(), middle, fast.end());
    evidence.usual_speed_m_s = *middle;
  }
  return evidence;
}

}  // namespace zonepack
