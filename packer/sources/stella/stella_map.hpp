// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "packer/record/damage.hpp"
#include "packer/record/record.hpp"

// A map of stella_vslam or OpenVSLAM as its file holds it, before it is placed.
// Frames: world = the first keyframe's camera; camera = optical: x right, y down, z forward.
namespace zonepack::packer {

struct StellaCamera {
  std::string setup, model;  // "Monocular", "Perspective"
  std::int32_t cols = 0, rows = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;      // pixels
  std::array<double, 6> k1_k2_p1_p2_k3_k4{};  // as stored
  double focal_x_baseline = 0;                // pixels times units

  bool metric() const { return setup == "Stereo" || setup == "RGBD"; }
};

struct OrbParameters {
  double scale_factor = 1.2;
  int levels = 8, ini_threshold = 20, min_threshold = 7;
};

struct StellaKeyframe {
  std::int32_t id = 0;
  double stamp_s = 0;
  std::string camera, orb;  // names
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
  std::size_t keypoints = 0;
  std::int32_t span_parent = -1;  // -1: none
  std::vector<std::int32_t> loop_edges;
  std::optional<Damage> damage;  // its row cannot be used
};

// Of one keyframe. All vectors are of equal length.
struct StellaFeatures {
  std::vector<float> x, y, size, angle, response;  // undistorted pixels; degrees
  std::vector<std::int32_t> octave, landmark;      // -1: none
  Bytes descriptors;                               // 32 bytes each
};

struct StellaMap {
  std::string version;  // "sqlite", "msgpack", "msgpack 2019"
  std::map<std::string, StellaCamera> cameras;
  std::map<std::string, OrbParameters> orb;
  std::vector<StellaKeyframe> keyframes;          // ascending id
  std::vector<std::int32_t> landmark_ids;         // ascending
  std::vector<std::array<double, 3>> landmarks;   // p_world of the same
  std::uint64_t features = 0, feature_bytes = 0;  // as the file holds them
  std::vector<std::string> warnings;

  // The landmark's place in the world; nullptr when there is none of this id.
  const std::array<double, 3>* landmark(std::int32_t id) const;
  const StellaKeyframe* find(std::int32_t id) const;
  OrbParameters orb_of(const StellaKeyframe& keyframe) const;
};

// Reads the features of one keyframe after the other. Throws DamagedSignature.
//
// Threads: one; another thread gets its own by reopen().
class StellaFeatureReader {
 public:
  virtual ~StellaFeatureReader() = default;
  virtual std::unique_ptr<StellaFeatureReader> reopen() const = 0;
  virtual void require_unchanged() const = 0;
  virtual void read(const StellaKeyframe& keyframe, StellaFeatures& into) = 0;
};

struct StellaFile {
  StellaMap map;
  std::unique_ptr<StellaFeatureReader> features;
};

// The size of a keypoint where the file holds none: ORB's patch of 31 pixels at its octave.
float keypoint_size(const OrbParameters& orb, std::int32_t octave);

// Sorts keyframes and landmarks by id. Throws where an id occurs twice or is out of range.
void sort_by_id(StellaMap& map, const std::string& file);

// Throws DamagedSignature unless the pose is a rotation and a place.
void require_camera_pose(const Eigen::Isometry3d& T_camera_world, const CellPlace& place);

}  // namespace zonepack::packer
