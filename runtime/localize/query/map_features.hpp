// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/client/signature_view.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack::localize {

// A feature of the map whose place in space is known.
struct MapPoint {
  float x_px = 0, y_px = 0;  // where the signature's own camera saw it, in its calibration's pixels
  float x_m = 0, y_m = 0, z_m = 0;  // in the signature's base
};

// One signature's features, copied out of a zone: 52 bytes each with 32-byte descriptors.
struct MapFeatures {
  SignatureId id = 0;
  ZoneId zone = kNoZone;
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  double fx_px = 0;    // of the signature's calibration; 0: it has none
  double reach_m = 0;  // distance of the farthest point from the camera
  std::vector<MapPoint> points;
  std::uint32_t descriptor_bytes = 0;
  std::vector<std::uint8_t> descriptors;  // points.size() * descriptor_bytes
};

// How differently a camera at `eye` sees a point of the map from how the signature's own did: the
// ratio of the distances, as a logarithm, and the angle between the views, in radians, together.
double view_change(const MapFeatures& map, const Eigen::Vector3d& p_map,
                   const Eigen::Vector3d& eye);

// Copies what a query needs. Nothing for a signature without a pose. Features without a point or
// with a descriptor of another length than `descriptor_bytes` are left out.
// A zone that is read in zoned's memory may change meanwhile: use the copy only after read()
// returned kOk.
std::optional<MapFeatures> copy_features(const SignatureView& signature, ZoneId zone,
                                         std::uint32_t descriptor_bytes);

// The same of every signature of a zone.
std::vector<MapFeatures> copy_features(const ZoneSignatures& signatures, ZoneId zone,
                                       std::uint32_t descriptor_bytes);

}  // namespace zonepack::localize
