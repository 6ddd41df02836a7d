// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

// From what the wheels did to what the robot did. Bit-exact: + - * / and det_math only.
// Real-time: no allocation, a fixed number of operations.
namespace zonepack {

enum class OdometryModel : std::uint8_t {
  kDifferentialPositions,  // left and right wheel positions, counters that may wrap
  kWheelSpeeds,            // left and right wheel speeds
  kTwist,                  // forward speed and yaw rate
  kAckermannPositions,     // distance of the driven axle and steering angle
  kAckermannSpeeds,        // speed of the driven axle and steering angle
  kMecanumPositions,       // front left, front right, rear left, rear right
  kMecanumSpeeds,
  kOmniPositions,  // 3 or 4 wheels around the middle, counter-clockwise
  kOmniSpeeds,
};

// Whether signals are positions, so that differences of counters are distances.
bool reads_positions(OdometryModel model) noexcept;

inline constexpr std::size_t kMostWheels = 4;
using PerWheel = std::array<double, kMostWheels>;

// Where the wheels are, base_link in their middle (of the rear axle: Ackermann).
struct WheelGeometry {
  double track_m = 0.413;       // between left and right contact points; not for kTwist and omni
  double slip_factor = 1;       // skid steering: a turn takes this much more than the track implies
  double wheelbase_m = 0.5;     // Ackermann, mecanum: between front and rear axle
  double omni_radius_m = 0.2;   // omni: from the middle to each wheel
  double omni_bearing_rad = 0;  // omni: of the first wheel seen from the middle; x is forward
  std::size_t omni_wheels = 3;  // 3 or 4, evenly around
};

// A short motion, or a speed (per second), in the frame of base_link.
struct BodyMotion {
  double forward_m = 0;
  double sideways_m = 0;  // to the left
  double turn_rad = 0;    // counter-clockwise
};

// The motion for ground distances (m) or speeds (m/s) of the wheels, in the order of the model; for
// kTwist of forward and turn; for Ackermann of the distance and the steering angle (rad;
// counter-clockwise, of a wheel in the middle of the front axle).
//
// Ground distances are along each wheel's rolling direction: forwards; for omni wheels
// counter-clockwise around the middle. Mecanum rollers are at 45 degrees, seen from above pointing
// to the middle.
//   differential  forward (l + r) / 2                     turn (r - l) / (track * slip_factor)
//   Ackermann     forward way                             turn way * tan(angle) / wheelbase
//   mecanum       forward (fl + fr + rl + rr) / 4         turn (-fl + fr - rl + rr) / (2 (track +
//                 sideways (-fl + fr + rl - rr) / 4            wheelbase))
//   omni, n wheels at bearings b
//                 forward -2/n sum(sin(b) w)  sideways 2/n sum(cos(b) w)  turn sum(w) / (n radius)
// Source of the last two: Siegwart, Nourbakhsh, Scaramuzza, "Autonomous Mobile Robots", 3.2.
class WheelModel {
 public:
  WheelModel(OdometryModel model, const WheelGeometry& geometry) noexcept;

  OdometryModel model() const noexcept { return model_; }
  std::size_t signals() const noexcept { return signals_; }
  // Signals that are distances or speeds of wheels: all, except none for a twist and one for
  // Ackermann.
  std::size_t wheels() const noexcept { return wheels_; }
  // Metres at a wheel for each radian of a turn, at most.
  double turn_arm_m() const noexcept { return turn_arm_m_; }

  BodyMotion motion(const PerWheel& ways) const noexcept;

 private:
  OdometryModel model_;
  WheelGeometry geometry_;
  std::size_t signals_ = 2;
  std::size_t wheels_ = 2;
  double turn_arm_m_ = 0;
  double turn_track_m_ = 0;
  PerWheel omni_forward_{};
  PerWheel omni_sideways_{};
};

}  // namespace zonepack
