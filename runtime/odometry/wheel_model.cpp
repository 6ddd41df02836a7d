// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/wheel_model.hpp"

#include "platform/base/require.hpp"
#include "runtime/odometry/det_math.hpp"

namespace zonepack {
namespace {

using Model = OdometryModel;

constexpr std::size_t kFl = 0, kFr = 1, kRl = 2, kRr = 3;

}  // namespace

bool reads_positions(OdometryModel model) noexcept {
  return model == Model::kDifferentialPositions || model == Model::kAckermannPositions ||
         model == Model::kMecanumPositions || model == Model::kOmniPositions;
}

WheelModel::WheelModel(OdometryModel model, const WheelGeometry& geometry) noexcept
    : model_(model), geometry_(geometry) {
  turn_track_m_ = geometry.track_m * geometry.slip_factor;
  turn_arm_m_ = turn_track_m_;
  switch (model) {
    case Model::kDifferentialPositions:
    case Model::kWheelSpeeds:
      break;
    case Model::kTwist:
      wheels_ = 0;
      break;
    case Model::kAckermannPositions:
    case Model::kAckermannSpeeds:
      wheels_ = 1;
      turn_arm_m_ = geometry.wheelbase_m;
      break;
    case Model::kMecanumPositions:
    case Model::kMecanumSpeeds:
      signals_ = wheels_ = 4;
      turn_arm_m_ = geometry.track_m + geometry.wheelbase_m;
      break;
    case Model::kOmniPositions:
    case Model::kOmniSpeeds: {
      ZP_REQUIRE(geometry.omni_wheels == 3 || geometry.omni_wheels == 4);
      signals_ = wheels_ = geometry.omni_wheels;
      turn_arm_m_ = geometry.omni_radius_m;
      const auto count = static_cast<double>(wheels_);
      for (std::size_t i = 0; i < wheels_; ++i) {
        const double bearing = geometry.omni_bearing_rad + 2 * kPi * static_cast<double>(i) / count;
        omni_forward_[i] = -2 / count * det_sin(bearing);
        omni_sideways_[i] = 2 / count * det_cos(bearing);
      }
      break;
    }
  }
}

BodyMotion WheelModel::motion(const PerWheel& w) const noexcept {
  switch (model_) {
    case Model::kDifferentialPositions:
    case Model::kWheelSpeeds:
      return {(w[0] + w[1]) * 0.5, 0, (w[1] - w[0]) / turn_track_m_};
    case Model::kTwist:
      break;
    case Model::kAckermannPositions:
    case Model::kAckermannSpeeds:
      return {w[0], 0, w[0] * (det_sin(w[1]) / det_cos(w[1])) / geometry_.wheelbase_m};
    case Model::kMecanumPositions:
    case Model::kMecanumSpeeds:
      return {(w[kFl] + w[kFr] + w[kRl] + w[kRr]) * 0.25,
              (-w[kFl] + w[kFr] + w[kRl] - w[kRr]) * 0.25,
              (-w[kFl] + w[kFr] - w[kRl] + w[kRr]) / (2 * turn_arm_m_)};
    case Model::kOmniPositions:
    case Model::kOmniSpeeds: {
      BodyMotion motion;
      double sum = 0;
      for (std::size_t i = 0; i < wheels_; ++i) {
        motion.forward_m += omni_forward_[i] * w[i];
        motion.sideways_m += omni_sideways_[i] * w[i];
        sum += w[i];
      }
      motion.turn_rad = sum / (static_cast<double>(wheels_) * geometry_.omni_radius_m);
      return motion;
    }
  }
  return {w[0], 0, w[1]};
}

}  // namespace zonepack
