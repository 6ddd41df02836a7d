// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/map_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace zonepack::localize {
namespace {

Eigen::Isometry3d isometry(const RigidTransform& m) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d rotation;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      rotation(static_cast<int>(row), static_cast<int>(column)) = m[row * 4 + column];
    }
    out.translation()(static_cast<int>(row)) = m[row * 4 + 3];
  }
  out.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  return out;
}

bool finite(const RigidTransform& m) {
  return std::all_of(m.begin(), m.end(), [](float value) { return std::isfinite(value); });
}

// The head of an RTAB-Map calibration of one camera (0.18 and later).
struct CalibrationHead {
  std::array<std::int32_t, 3> version;
  std::int32_t kind;  // 0: one camera
  std::int32_t width, height;
  std::array<std::int32_t, 5> counts;  // of K, D, R, P and the local transform
};
static_assert(sizeof(CalibrationHead) == 44);

// The focal length and mount of the first camera. Nothing where the source stored another kind.
void read_camera(ByteSpan bytes, MapFeatures& into) {
  CalibrationHead head;
  if (bytes.size() < sizeof head) return;
  std::memcpy(&head, bytes.data(), sizeof head);
  if (head.kind != 0 || head.width < 1 || head.height < 1 || head.counts[0] != 9 ||
      head.counts[4] != 12) {
    return;
  }
  std::size_t doubles = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (head.counts[i] < 0 || head.counts[i] > 64) return;
    doubles += static_cast<std::size_t>(head.counts[i]);
  }
  const std::size_t mount_at = sizeof head + doubles * sizeof(double);
  RigidTransform mount;
  if (bytes.size() < mount_at + sizeof mount) return;
  std::memcpy(&mount, bytes.data() + mount_at, sizeof mount);
  double fx = 0;
  std::memcpy(&fx, bytes.data() + sizeof head, sizeof fx);
  if (!finite(mount) || !std::isfinite(fx) || fx <= 0) return;
  into.fx_px = fx;
  into.T_base_camera = isometry(mount);
}

}  // namespace

double view_change(const MapFeatures& map, const Eigen::Vector3d& p_map,
                   const Eigen::Vector3d& eye) {
  const Eigen::Vector3d now = p_map - eye;
  const Eigen::Vector3d then = p_map - map.T_map_base * map.T_base_camera.translation();
  const double turned = std::acos(std::clamp(now.normalized().dot(then.normalized()), -1.0, 1.0));
  return std::abs(std::log(now.norm() / then.norm())) + turned;
}

std::optional<MapFeatures> copy_features(const SignatureView& signature, ZoneId zone,
                                         std::uint32_t descriptor_bytes) {
  const auto pose = signature.T_map_base();
  if (!pose || !finite(*pose)) return std::nullopt;
  MapFeatures out;
  out.id = signature.id();
  out.zone = zone;
  out.T_map_base = isometry(*pose);
  out.descriptor_bytes = descriptor_bytes;
  read_camera(signature.calibration(), out);
  const FeaturesView features = signature.features();
  const std::uint32_t size = features.size();
  out.points.reserve(size);
  out.descriptors.reserve(std::size_t{size} * descriptor_bytes);
  const Eigen::Vector3d camera = out.T_base_camera.translation();
  features.for_each([&](const Feature& feature) {
    const auto& p = feature.p_base;
    if (feature.descriptor.size() != descriptor_bytes || !std::isfinite(p[0]) ||
        !std::isfinite(p[1]) || !std::isfinite(p[2])) {
      return;
    }
    out.points.push_back({feature.x_px, feature.y_px, p[0], p[1], p[2]});
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(feature.descriptor.data());
    out.descriptors.insert(out.descriptors.end(), bytes, bytes + descriptor_bytes);
    out.reach_m = std::max(out.reach_m, (Eigen::Vector3d(p[0], p[1], p[2]) - camera).norm());
  });
  return out;
}

std::vector<MapFeatures> copy_features(const ZoneSignatures& signatures, ZoneId zone,
                                       std::uint32_t descriptor_bytes) {
  std::vector<MapFeatures> out;
  for (std::uint32_t i = 0; i < signatures.size(); ++i) {
    if (auto one = copy_features(signatures[i], zone, descriptor_bytes)) {
      out.push_back(std::move(*one));
    }
  }
  return out;
}

}  // namespace zonepack::localize
