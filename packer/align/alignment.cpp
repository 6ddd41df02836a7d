// SPDX-License-Identifier: Apache-2.0
#include "packer/align/alignment.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

#include "packer/align/trajectory.hpp"
#include "packer/align/umeyama.hpp"

namespace zonepack::packer {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr std::size_t kLeastPairs = 3;
constexpr double kRadians = std::numbers::pi / 180;
constexpr double kWronglyTurned_deg = 5;
constexpr double kStraight = 0.02;  // a path this much narrower than long has no roll about itself

std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string seconds(double s) { return text("%.3f", s); }

// Square roots of the variances along the principal axes, largest first.
Vector3d spread_of(const Matrix3Xd& points) {
  const Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Matrix3d covariance = centred * centred.transpose() / static_cast<double>(points.cols());
  const Vector3d variances = Eigen::SelfAdjointEigenSolver<Matrix3d>(covariance).eigenvalues();
  return {std::sqrt(std::max(0.0, variances[2])), std::sqrt(std::max(0.0, variances[1])),
          std::sqrt(std::max(0.0, variances[0]))};
}

// Of a camera that looks along x: its right is -y, its down -z.
Matrix3d optical_axes() {
  Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return R;
}

std::string mount_text(const Isometry3d& T_base_optical) {
  std::string out;
  for (const double value : camera_in_base(T_base_optical)) {
    out += (out.empty() ? "" : ",") + text("%.4g", std::abs(value) < 5e-5 ? 0 : value);
  }
  return out;
}

// Whether places spread at least this share of their length to the side; on a line the fit is free.
bool spans(const Matrix3Xd& places, double share) {
  const Vector3d spread = spread_of(places);
  return spread[1] > share * spread[0];
}

Similarity fit(const Matrix3Xd& from, const Matrix3Xd& to) {
  const auto points = [](const Matrix3Xd& columns) {
    std::vector<Point3> out;
    out.reserve(static_cast<std::size_t>(columns.cols()));
    for (const auto& p : columns.colwise()) out.push_back({p.x(), p.y(), p.z()});
    return out;
  };
  const PointTransform T = fit_points(points(from), points(to), FitModel::kSimilarity).T_to_from;
  Similarity s;
  s.metres_per_unit = T.scale;
  s.R_map_world = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(T.rotation.data());
  s.t_map_world = Vector3d(T.translation.data());
  return s;
}

std::vector<double> residuals_of(const Similarity& s, const Matrix3Xd& from, const Matrix3Xd& to) {
  std::vector<double> residuals;
  for (Eigen::Index i = 0; i < from.cols(); ++i) {
    residuals.push_back((s.point(from.col(i)) - to.col(i)).norm());
  }
  return residuals;
}

double at_share(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

Matrix3Xd columns_at(const Matrix3Xd& all, const std::vector<Eigen::Index>& kept) {
  Matrix3Xd out(3, static_cast<Eigen::Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i) {
    out.col(static_cast<Eigen::Index>(i)) = all.col(kept[i]);
  }
  return out;
}

// The fit of most places, however far a few are off: begins with that of all or of three, taken a
// third of the way apart, which has the least median residual, and then twice takes all places
// within three times the median.
Similarity fit_most(const Matrix3Xd& from, const Matrix3Xd& to) {
  constexpr Eigen::Index kTriples = 64;
  const Eigen::Index n = from.cols();
  const auto median = [&](const Similarity& s) { return at_share(residuals_of(s, from, to), 0.5); };
  Similarity best = fit(from, to);
  double least = median(best);
  for (Eigen::Index i = 0; i < std::min(n, kTriples); ++i) {
    const Eigen::Index first = i * n / std::min(n, kTriples);
    const std::vector<Eigen::Index> triple = {first, (first + n / 3) % n, (first + 2 * n / 3) % n};
    const Matrix3Xd three = columns_at(from, triple), there = columns_at(to, triple);
    if (!spans(three, 0.1) || !spans(there, kStraight)) continue;
    const Similarity s = fit(three, there);
    if (const double m = median(s); m < least) {
      least = m;
      best = s;
    }
  }
  for (int round = 0; round < 2; ++round) {
    const std::vector<double> residuals = residuals_of(best, from, to);
    const double gate = 3 * at_share(residuals, 0.5);
    std::vector<Eigen::Index> kept;
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      if (residuals[i] <= gate) kept.push_back(static_cast<Eigen::Index>(i));
    }
    const Matrix3Xd near = columns_at(from, kept), there = columns_at(to, kept);
    if (kept.size() < kLeastPairs || !spans(near, kStraight) || !spans(there, kStraight)) break;
    best = fit(near, there);
  }
  return best;
}

void require_meeting(const std::vector<KeyframePose>& keyframes, const Trajectory& trajectory,
                     std::size_t pairs, const FramePlacement& placement,
                     const std::string& source) {
  if (pairs >= kLeastPairs) return;
  const auto [first, last] = std::ranges::minmax(keyframes, {}, &KeyframePose::stamp_s);
  throw std::runtime_error(placement.trajectory.string() + ": covers " + std::to_string(pairs) +
                           " of the " + std::to_string(keyframes.size()) + " keyframes of " +
                           source + ", expected 3 or more; its " + "stamps go from " +
                           seconds(trajectory.poses().front().stamp_s) + " to " +
                           seconds(trajectory.poses().back().stamp_s) + ", the keyframes' from " +
                           seconds(first.stamp_s) + " to " + seconds(last.stamp_s) +
                           ". Give the trajectory of the same drive, by the same clock");
}

// How the camera is turned in the base: the mean of what each keyframe and the trajectory at its
// stamp say, nearest to all of them (by singular values).
Eigen::Quaterniond turned_in_base(const std::vector<KeyframePose>& keyframes,
                                  const Trajectory& trajectory, const Similarity& s) {
  Matrix3d sum = Matrix3d::Zero();
  for (const KeyframePose& keyframe : keyframes) {
    const auto base = trajectory.at(keyframe.stamp_s);
    if (base) sum += base->linear().transpose() * s.R_map_world * keyframe.T_world_camera.linear();
  }
  const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d R = svd.matrixU() * svd.matrixV().transpose();
  if (R.determinant() < 0) {
    Matrix3d flipped = svd.matrixU();
    flipped.col(2) = -flipped.col(2);
    R = flipped * svd.matrixV().transpose();
  }
  return Eigen::Quaterniond(R);
}

void use_turn(const Eigen::Quaterniond& turn, const FramePlacement& placement, Alignment& out) {
  const Isometry3d found = Eigen::Translation3d(out.T_base_camera.translation()) * turn;
  const double apart_deg =
      turn.angularDistance(Eigen::Quaterniond(out.T_base_camera.linear())) / kRadians;
  if (!placement.camera_in_base) {
    out.T_base_camera = found;
    out.notes.push_back("the camera is turned in the base as --camera-in-base " +
                        mount_text(found) + " says; its place there is not known and taken for 0");
  } else if (apart_deg > kWronglyTurned_deg) {
    out.warnings.push_back("--camera-in-base turns the camera " + text("%.0f", apart_deg) +
                           " degrees away from where the keyframes look by the trajectory; what "
                           "fits is --camera-in-base " +
                           mount_text(found));
  }
}

void align_to_trajectory(const std::vector<KeyframePose>& keyframes,
                         const FramePlacement& placement, const std::string& source,
                         Alignment& out) {
  const Trajectory trajectory = Trajectory::read(placement.trajectory);
  std::vector<Vector3d> from_list, to_list;
  for (const KeyframePose& keyframe : keyframes) {
    const auto base = trajectory.at(keyframe.stamp_s);
    if (!base) continue;
    from_list.push_back(keyframe.T_world_camera.translation());
    to_list.push_back(*base * out.T_base_camera.translation());
  }
  require_meeting(keyframes, trajectory, from_list.size(), placement, source);
  const auto columns = [](const std::vector<Vector3d>& list) {
    Matrix3Xd all(3, static_cast<Eigen::Index>(list.size()));
    for (std::size_t i = 0; i < list.size(); ++i) all.col(static_cast<Eigen::Index>(i)) = list[i];
    return all;
  };
  const Matrix3Xd from = columns(from_list), to = columns(to_list);
  if (!spans(from, kStraight) || !spans(to, kStraight)) {
    throw std::runtime_error(
        placement.trajectory.string() + ": the keyframes of " + source +
        " stand on a line, so their places alone do not say which side is up; give --scale, --up "
        "and --camera-in-base instead of --align");
  }
  const Similarity s = fit_most(from, to);
  const std::vector<double> residuals = residuals_of(s, from, to);
  if (!(s.metres_per_unit > 0) || !std::isfinite(s.metres_per_unit)) {
    throw std::runtime_error(placement.trajectory.string() +
                             ": no similarity fits the keyframes of " + source);
  }
  out.into_map = s;
  use_turn(turned_in_base(keyframes, trajectory, s), placement, out);
  out.notes.push_back("aligned with " + placement.trajectory.string() + ": " +
                      std::to_string(from_list.size()) + " of " + std::to_string(keyframes.size()) +
                      " keyframes, 1 unit is " + text("%.6g", s.metres_per_unit) +
                      " m, residuals p50 " + text("%.3f", at_share(residuals, 0.5)) + " m, p95 " +
                      text("%.3f", at_share(residuals, 0.95)) + " m, most " +
                      text("%.3f", at_share(residuals, 1)) + " m");
}

// The unit vector across the plane through the keyframes' places, on the side where the cameras
// have their tops; the mean of these where the places span no plane.
Vector3d up_of(const std::vector<KeyframePose>& keyframes, Alignment& out) {
  Vector3d tops = Vector3d::Zero();
  Matrix3Xd places(3, static_cast<Eigen::Index>(keyframes.size()));
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    tops -= keyframes[i].T_world_camera.linear().col(1);
    places.col(static_cast<Eigen::Index>(i)) = keyframes[i].T_world_camera.translation();
  }
  Vector3d top = tops.normalized();
  const Matrix3Xd centred = places.colwise() - places.rowwise().mean();
  const Matrix3d covariance = centred * centred.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(covariance);
  const Vector3d spread = spread_of(places);
  Vector3d normal = axes.eigenvectors().col(0);
  if (normal.dot(top) < 0) normal = -normal;
  const bool plane = spread[1] > kStraight * spread[0] && spread[2] < 0.5 * spread[1];
  const double apart_deg =
      std::acos(std::clamp(normal.dot(top), -1.0, 1.0)) * 180 / std::numbers::pi;
  if (plane && apart_deg < 30) {
    out.notes.push_back("up is across the plane of the keyframes, " + text("%.1f", apart_deg) +
                        " degrees from where the cameras have their tops on average");
    return normal;
  }
  out.warnings.push_back(
      "the keyframes span no plane that the cameras stand upright on, so up is where they have "
      "their "
      "tops on average; give --up x,y,z if that is wrong");
  return top;
}

}  // namespace

Isometry3d optical_in_base(const std::array<double, 6>& c) {
  const Eigen::Quaterniond turn = Eigen::AngleAxisd(c[5] * kRadians, Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(c[4] * kRadians, Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(c[3] * kRadians, Vector3d::UnitX());
  return Eigen::Translation3d(c[0], c[1], c[2]) * turn * Eigen::Quaterniond(optical_axes());
}

std::array<double, 6> camera_in_base(const Isometry3d& T_base_optical) {
  const Matrix3d R = T_base_optical.linear() * optical_axes().transpose();
  const Vector3d p = T_base_optical.translation();
  const double roll = std::atan2(R(2, 1), R(2, 2));
  const double pitch = std::asin(std::clamp(-R(2, 0), -1.0, 1.0));
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  return {p.x(), p.y(), p.z(), roll / kRadians, pitch / kRadians, yaw / kRadians};
}

Alignment align_keyframes(const std::vector<KeyframePose>& keyframes,
                          const FramePlacement& placement, bool metric, const std::string& source) {
  Alignment out;
  out.T_base_camera = optical_in_base(placement.camera_in_base.value_or(std::array<double, 6>{}));
  if (keyframes.empty()) return out;
  if (!placement.trajectory.empty()) {
    align_to_trajectory(keyframes, placement, source, out);
    return out;
  }
  Similarity& s = out.into_map;
  s.metres_per_unit = placement.metres_per_unit.value_or(1);
  if (!metric && !placement.metres_per_unit) {
    out.warnings.push_back(
        source +
        ": was made with one camera, so the length of its unit is unknown and is "
        "taken for a metre; give --scale METRES or --align TRAJECTORY");
  }
  const Vector3d up =
      placement.up ? Vector3d(placement.up->data()).normalized() : up_of(keyframes, out);
  const Isometry3d& first = keyframes.front().T_world_camera;
  const Isometry3d T_camera_base = out.T_base_camera.inverse();
  const Vector3d base_forward = first.linear() * T_camera_base.linear().col(0);
  Vector3d forward = base_forward - up * up.dot(base_forward);
  if (forward.norm() < 1e-3) {
    throw std::runtime_error(source + ": the first keyframe's robot looks straight up or down by " +
                             "--up and --camera-in-base, so the map has no forward; check both");
  }
  forward.normalize();
  s.R_map_world.row(0) = forward;
  s.R_map_world.row(1) = up.cross(forward);
  s.R_map_world.row(2) = up;
  s.t_map_world = Vector3d::Zero();
  const Isometry3d base = s.pose(first) * T_camera_base;
  s.t_map_world = -base.translation();
  return out;
}

}  // namespace zonepack::packer
