// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "packer/align/alignment.hpp"
#include "packer/record/source_kind.hpp"
#include "packer/sources/stella/stella_map.hpp"

namespace zonepack::packer {

// A map of stella_vslam or OpenVSLAM, placed: a keyframe is a signature of the same id.
//
// pose: T_map_base, from the camera's pose and where the camera stands on the robot. Features:
// undistorted keypoints, their landmark's id as word id (-1: none) and its place in the base
// frame. Links: to the parent in the spanning tree as a neighbour, loop edges as global closures.
// Calibration: the camera as RTAB-Map 0.18 writes one.
//
// Memory: all landmarks (28 bytes each), and of a MessagePack file all features.
class StellaSource : public MapSource {
 public:
  StellaSource(StellaFile file, const SourceOptions& options);

  std::unique_ptr<MapSource> reopen() const override;
  const MapOutline& outline() const noexcept override { return shared_->outline; }
  void require_unchanged() const override { features_->require_unchanged(); }
  void read(std::int32_t id, const PayloadSet& wanted, SignatureRecord& into) override;
  using MapSource::read;

 private:
  struct Shared {
    std::string name;
    StellaMap map;
    Alignment alignment;
    MapOutline outline;

    Eigen::Isometry3d T_map_base(const StellaKeyframe& keyframe) const;
  };
  StellaSource(std::shared_ptr<const Shared> shared, std::unique_ptr<StellaFeatureReader> features);

  static std::shared_ptr<const Shared> place(StellaMap map, const SourceOptions& options);
  void read_features(const StellaKeyframe& keyframe, Features& into);
  void read_links(const StellaKeyframe& keyframe, std::vector<Link>& into) const;

  std::shared_ptr<const Shared> shared_;
  std::unique_ptr<StellaFeatureReader> features_;
  StellaFeatures buffer_;
};

}  // namespace zonepack::packer
