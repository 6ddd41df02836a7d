// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/check/calibration_watch.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/localize/solve/sighting.hpp"

namespace zonepack::localize {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180;
constexpr double kLoss_px = 2;  // scale of Geman and McClure's loss, at the usual focal length
// How a robot stands over the floor that the map's signatures were seen from.
constexpr double kFloorSigma_m = 0.01, kTiltSigma_rad = 0.3 * kDegree_rad;
constexpr CameraTraits kLeastOfNote = {0.006, 0.012, 0.2 * kDegree_rad, 0.2 * kDegree_rad};

// What maps are off by themselves, which no number of fixes averages out, as a standard deviation:
// this share of what is of note. Four pairs of a map and a drive have 0.06 %, 0.12 cm, 0.03
// degrees.
constexpr double kMapShare = 0.125;

constexpr std::array<CameraTrait, kCameraTraits> kAll = {CameraTrait::kFocal, CameraTrait::kHeight,
                                                         CameraTrait::kPitch, CameraTrait::kRoll};

std::size_t place(CameraTrait trait) { return static_cast<std::size_t>(trait); }
Eigen::Index row(CameraTrait trait) { return static_cast<Eigen::Index>(trait); }

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d out;
  out << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return out;
}

double sigmas(const CalibrationFinding& finding) {
  return finding.sigma > 0 ? std::abs(finding.value) / finding.sigma : 0;
}

}  // namespace

const char* to_string(CameraTrait trait) noexcept {
  switch (trait) {
    case CameraTrait::kFocal:
      return "focal";
    case CameraTrait::kHeight:
      return "height";
    case CameraTrait::kPitch:
      return "pitch";
    case CameraTrait::kRoll:
      return "roll";
  }
  return "unknown";
}

double least_of_note(CameraTrait trait) noexcept { return kLeastOfNote[place(trait)]; }

bool is_clear(const CalibrationFinding& finding) noexcept {
  return sigmas(finding) >= CalibrationWatch::kSignificant &&
         std::abs(finding.value) >= least_of_note(finding.trait);
}

CameraModel corrected(const CameraModel& camera, const CameraTraits& by) {
  CameraModel out = camera;
  out.fx *= 1 + by[place(CameraTrait::kFocal)];
  out.fy *= 1 + by[place(CameraTrait::kFocal)];
  out.T_base_camera.translation().z() += by[place(CameraTrait::kHeight)];
  const Eigen::AngleAxisd pitch(by[place(CameraTrait::kPitch)], Eigen::Vector3d::UnitY());
  const Eigen::AngleAxisd roll(by[place(CameraTrait::kRoll)], Eigen::Vector3d::UnitX());
  out.T_base_camera.linear() = (roll * pitch).toRotationMatrix() * camera.T_base_camera.linear();
  return out;
}

void CalibrationWatch::Normal::add(const Normal& other) {
  information += other.information;
  gradient += other.gradient;
  fixes += other.fixes;
}

// Unknown: the pose (translation in the map, rotation in the base) and the traits.
CalibrationWatch::Normal CalibrationWatch::normal_of(const CameraModel& camera,
                                                     const QueryResult& fix) {
  constexpr int kPose = 6, kUnknown = kPose + static_cast<int>(kCameraTraits);
  using Row = Eigen::Matrix<double, 1, kUnknown>;
  Eigen::Matrix<double, kUnknown, kUnknown> information =
      Eigen::Matrix<double, kUnknown, kUnknown>::Zero();
  Eigen::Matrix<double, kUnknown, 1> gradient = Eigen::Matrix<double, kUnknown, 1>::Zero();
  const auto add = [&](const auto& J, const auto& r, double weight) {
    information.noalias() += J.transpose() * (weight * J);
    gradient.noalias() -= J.transpose() * (weight * r);
  };

  const Eigen::Isometry3d& T = fix.T_map_base;
  const Eigen::Isometry3d T_camera_base = camera.T_base_camera.inverse();
  const Eigen::Matrix3d R_base_map = T.linear().transpose();
  const Eigen::Matrix3d R_camera_base = T_camera_base.linear();
  const double scale = camera.fx / kUsualFocal_px;
  const double loss2 = std::pow(kLoss_px * scale, 2);
  // Several signatures may see one feature with the same error.
  const double distinct = static_cast<double>(fix.distinct) / std::max(1, fix.inliers);
  for (const DrawnMatch& match : fix.drawn) {
    if (!match.inlier) continue;
    const Eigen::Vector2d px = camera.undistort({match.x_px, match.y_px});
    const Eigen::Vector3d p_base = T.inverse() * match.p_map.cast<double>();
    const Eigen::Vector3d p = T_camera_base * p_base;
    if (p.z() < kLeastDepth) continue;
    const Eigen::Vector2d ray(camera.fx * p.x() / p.z(), camera.fy * p.y() / p.z());
    const Eigen::Vector2d r = ray + Eigen::Vector2d(camera.cx, camera.cy) - px;
    const double root = loss2 / (loss2 + r.squaredNorm());
    Eigen::Matrix<double, 2, 3> by_camera;
    by_camera << camera.fx / p.z(), 0, -ray.x() / p.z(), 0, camera.fy / p.z(), -ray.y() / p.z();
    const Eigen::Matrix<double, 2, 3> by_base = by_camera * R_camera_base;
    Eigen::Matrix<double, 2, kUnknown> J;
    J.leftCols<3>() = -by_base * R_base_map;
    J.middleCols<3>(3) = by_base * cross(p_base);
    const Eigen::Vector3d arm = p_base - camera.T_base_camera.translation();
    J.col(kPose + row(CameraTrait::kFocal)) = ray;
    J.col(kPose + row(CameraTrait::kHeight)) = -by_base * Eigen::Vector3d::UnitZ();
    J.col(kPose + row(CameraTrait::kPitch)) = -by_base * Eigen::Vector3d::UnitY().cross(arm);
    J.col(kPose + row(CameraTrait::kRoll)) = -by_base * Eigen::Vector3d::UnitX().cross(arm);
    add(J, r, distinct * root * root / (scale * scale));
  }
  Row up = Row::Zero();
  up(2) = 1;
  add(up, Eigen::Matrix<double, 1, 1>(T.translation().z() - fix.floor_z_m),
      1 / (kFloorSigma_m * kFloorSigma_m));
  const Eigen::Vector3d up_base = T.linear().transpose() * Eigen::Vector3d::UnitZ();
  for (int axis = 0; axis < 2; ++axis) {
    Row tilt = Row::Zero();
    tilt.segment<3>(3) = cross(up_base).row(axis);
    add(tilt, Eigen::Matrix<double, 1, 1>(up_base(axis)), 1 / (kTiltSigma_rad * kTiltSigma_rad));
  }

  information.diagonal().head<kPose>().array() += 1e-9;
  const Eigen::LDLT<Eigen::Matrix<double, kPose, kPose>> pose(
      information.topLeftCorner<kPose, kPose>());
  const auto across = information.topRightCorner<kPose, kCameraTraits>();
  Normal out;
  out.information = information.bottomRightCorner<kCameraTraits, kCameraTraits>() -
                    across.transpose() * pose.solve(across);
  out.gradient =
      gradient.tail<kCameraTraits>() - across.transpose() * pose.solve(gradient.head<kPose>());
  out.fixes = 1;
  return out;
}

void CalibrationWatch::add(const CameraModel& camera, const QueryResult& fix) {
  if (!fix.accepted) return;
  const Normal normal = normal_of(camera, fix);
  if (!normal.information.allFinite() || !normal.gradient.allFinite()) return;
  ++fixes_;
  if (!groups_.empty() && groups_.back().fixes < fixes_of_group_) {
    groups_.back().add(normal);
    return;
  }
  if (groups_.size() == kMostGroups) {
    for (std::size_t i = 0; i < kMostGroups / 2; ++i) {
      Normal two = groups_[2 * i];
      two.add(groups_[2 * i + 1]);
      groups_[i] = two;
    }
    groups_.resize(kMostGroups / 2);
    fixes_of_group_ *= 2;
  }
  groups_.push_back(normal);
}

std::optional<CalibrationWatch::Estimate> CalibrationWatch::estimate(const Subset& subset) const {
  const auto size = static_cast<Eigen::Index>(subset.size());
  const auto part = [&](const Normal& all, Eigen::MatrixXd& A, Eigen::VectorXd& b) {
    A.resize(size, size);
    b.resize(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      const Eigen::Index from = row(subset[static_cast<std::size_t>(i)]);
      b(i) = all.gradient(from);
      for (Eigen::Index j = 0; j < size; ++j) {
        A(i, j) = all.information(from, row(subset[static_cast<std::size_t>(j)]));
      }
    }
  };
  Normal sum;
  for (const Normal& group : groups_) sum.add(group);
  Eigen::MatrixXd A, group_A;
  Eigen::VectorXd b, group_b;
  part(sum, A, b);
  const Eigen::LLT<Eigen::MatrixXd> factor(A);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::VectorXd values = factor.solve(b);
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(size, size);
  for (const Normal& group : groups_) {
    part(group, group_A, group_b);
    const Eigen::VectorXd off = group_b - group_A * values;
    scatter += off * off.transpose();
  }
  const auto count = static_cast<double>(groups_.size());
  scatter *= count / (count - static_cast<double>(size));
  const Eigen::MatrixXd covariance = factor.solve(factor.solve(scatter).transpose());
  Estimate out;
  out.explained = b.dot(values);
  for (Eigen::Index i = 0; i < size; ++i) {
    const CameraTrait trait = subset[static_cast<std::size_t>(i)];
    const double of_fixes = std::sqrt(std::max(0.0, covariance(i, i)));
    out.values.push_back(
        {trait, values(i), std::hypot(of_fixes, kMapShare * least_of_note(trait))});
  }
  return out;
}

std::vector<CalibrationFinding> CalibrationWatch::together(
    const std::vector<CameraTrait>& traits) const {
  if (groups_.size() <= traits.size()) return {};
  auto estimated = estimate(traits);
  return estimated ? std::move(estimated->values) : std::vector<CalibrationFinding>{};
}

CalibrationReport CalibrationWatch::report() const {
  CalibrationReport out;
  out.fixes = fixes_;
  out.enough = groups_.size() >= kLeastGroups;
  if (!out.enough) return out;
  for (const CameraTrait trait : kAll) {
    const auto alone = estimate({trait});
    out.each[place(trait)] = alone ? alone->values.front() : CalibrationFinding{trait, 0, 0};
  }
  Subset subset;
  std::vector<CalibrationFinding> found;
  while (subset.size() < kCameraTraits) {
    // The one that explains most next to those that were taken, if all then count.
    std::optional<Estimate> best;
    for (const CameraTrait trait : kAll) {
      if (std::ranges::find(subset, trait) != subset.end()) continue;
      Subset more = subset;
      more.push_back(trait);
      auto tried = estimate(more);
      if (!tried || !is_clear(tried->values.back())) continue;
      if (!best || tried->explained > best->explained) best = std::move(tried);
    }
    if (!best) break;
    // One that was taken earlier may be explained by the new one.
    subset.clear();
    for (const CalibrationFinding& value : best->values) {
      if (is_clear(value)) subset.push_back(value.trait);
    }
    const bool dropped = subset.size() < best->values.size();
    found = std::move(best->values);
    if (dropped) {
      if (auto rest = estimate(subset)) found = std::move(rest->values);
      break;
    }
  }
  std::ranges::sort(found, [](const CalibrationFinding& a, const CalibrationFinding& b) {
    return sigmas(a) > sigmas(b);
  });
  out.findings = std::move(found);
  return out;
}

}  // namespace zonepack::localize
