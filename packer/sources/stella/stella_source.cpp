// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/stella/stella_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>

namespace zonepack::packer {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

Transform transform_of(const Eigen::Isometry3d& T) {
  Transform out;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      out[static_cast<std::size_t>(row * 4 + column)] = static_cast<float>(T.matrix()(row, column));
    }
  }
  return out;
}

template <typename T>
void append_value(Bytes& bytes, const T& value) {
  const auto* const data = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), data, data + sizeof value);
}

// As RTAB-Map 0.18 and later write one camera: 11 int32, K, the distortion, P for a camera with a
// baseline, and T_base_camera. Empty for a camera that is no pinhole.
Bytes calibration_of(const StellaCamera& camera, const Eigen::Isometry3d& T_base_camera) {
  if (!(camera.fx > 0) || !(camera.fy > 0) || camera.cols < 1 || camera.rows < 1) return {};
  const auto& d = camera.k1_k2_p1_p2_k3_k4;
  std::vector<double> distortion;
  if (camera.model == "Perspective") distortion = {d[0], d[1], d[2], d[3], d[4]};
  if (camera.model == "Fisheye") distortion = {d[0], d[1], 0, 0, d[4], d[5]};
  const std::array<double, 9> K = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  std::vector<double> P;
  if (camera.focal_x_baseline != 0) {
    P = {K[0], 0, K[2], -camera.focal_x_baseline, 0, K[4], K[5], 0, 0, 0, 1, 0};
  }
  const std::array<std::int32_t, 11> head = {
      0,           18,
      0,           0,
      camera.cols, camera.rows,
      9,           static_cast<std::int32_t>(distortion.size()),
      0,           static_cast<std::int32_t>(P.size()),
      12};
  Bytes bytes;
  for (const std::int32_t value : head) append_value(bytes, value);
  for (const double value : K) append_value(bytes, value);
  for (const double value : distortion) append_value(bytes, value);
  for (const double value : P) append_value(bytes, value);
  append_value(bytes, transform_of(T_base_camera));
  return bytes;
}

// The detector in RTAB-Map's words: 2 is ORB.
std::string detector_of(const StellaMap& map) {
  std::size_t most = 0;
  for (const StellaKeyframe& keyframe : map.keyframes) most = std::max(most, keyframe.keypoints);
  if (most == 0) return "";
  const OrbParameters orb = map.orb_of(map.keyframes.front());
  char settings[200];
  std::snprintf(settings, sizeof settings,
                "2 Kp/MaxFeatures:%zu;FAST/Threshold:%d;ORB/NLevels:%d;ORB/ScaleFactor:%.9g", most,
                orb.ini_threshold, orb.levels,
                static_cast<double>(static_cast<float>(orb.scale_factor)));
  return settings;
}

}  // namespace

Eigen::Isometry3d StellaSource::Shared::T_map_base(const StellaKeyframe& keyframe) const {
  return alignment.into_map.pose(keyframe.T_camera_world.inverse()) *
         alignment.T_base_camera.inverse();
}

std::shared_ptr<const StellaSource::Shared> StellaSource::place(StellaMap map,
                                                                const SourceOptions& options) {
  auto shared = std::make_shared<Shared>();
  shared->name = options.name();
  shared->map = std::move(map);
  const StellaMap& from = shared->map;
  std::vector<KeyframePose> poses;
  bool metric = true;
  for (const StellaKeyframe& keyframe : from.keyframes) {
    if (keyframe.damage) continue;
    poses.push_back({keyframe.stamp_s, keyframe.T_camera_world.inverse()});
    const auto camera = from.cameras.find(keyframe.camera);
    metric = metric && camera != from.cameras.end() && camera->second.metric();
  }
  shared->alignment = align_keyframes(poses, options.placement, metric, shared->name);
  MapOutline& outline = shared->outline;
  outline.kind = "stella";
  outline.schema_version = from.version;
  outline.warnings = from.warnings;
  const Alignment& alignment = shared->alignment;
  outline.warnings.insert(outline.warnings.end(), alignment.warnings.begin(),
                          alignment.warnings.end());
  outline.notes = alignment.notes;
  outline.has_optimised_poses = true;
  outline.feature_count = from.features;
  outline.feature_bytes = from.feature_bytes;
  outline.detector = detector_of(from);
  for (const StellaKeyframe& keyframe : from.keyframes) {
    NodeOutline& node = outline.nodes.emplace_back();
    node.id = keyframe.id;
    node.stamp = keyframe.stamp_s;
    node.damaged = keyframe.damage.has_value();
    if (node.damaged) {
      outline.damages.push_back(*keyframe.damage);
    } else {
      node.pose = transform_of(shared->T_map_base(keyframe));
    }
  }
  return shared;
}

StellaSource::StellaSource(StellaFile file, const SourceOptions& options)
    : shared_(place(std::move(file.map), options)), features_(std::move(file.features)) {}

StellaSource::StellaSource(std::shared_ptr<const Shared> shared,
                           std::unique_ptr<StellaFeatureReader> features)
    : shared_(std::move(shared)), features_(std::move(features)) {}

std::unique_ptr<MapSource> StellaSource::reopen() const {
  return std::unique_ptr<MapSource>(new StellaSource(shared_, features_->reopen()));
}

void StellaSource::read(std::int32_t id, const PayloadSet& wanted, SignatureRecord& into) {
  const StellaKeyframe* const keyframe = shared_->map.find(id);
  if (keyframe == nullptr) {
    throw std::runtime_error(shared_->name + ": has no keyframe " + std::to_string(id));
  }
  if (keyframe->damage) throw DamagedSignature(shared_->name, *keyframe->damage);
  into = SignatureRecord();
  into.id = keyframe->id;
  into.stamp = keyframe->stamp_s;
  into.pose = transform_of(shared_->T_map_base(*keyframe));
  if (const auto camera = shared_->map.cameras.find(keyframe->camera);
      camera != shared_->map.cameras.end()) {
    into.calibration = calibration_of(camera->second, shared_->alignment.T_base_camera);
  }
  read_links(*keyframe, into.links);
  if (wanted.features) read_features(*keyframe, into.features);
}

void StellaSource::read_features(const StellaKeyframe& keyframe, Features& into) {
  features_->read(keyframe, buffer_);
  const std::size_t n = buffer_.x.size();
  into.count = n;
  into.x = buffer_.x;
  into.y = buffer_.y;
  into.size = buffer_.size;
  into.angle = buffer_.angle;
  into.response = buffer_.response;
  into.octave = buffer_.octave;
  into.descriptor_type = n == 0 ? Features::DescriptorType::kNone : Features::DescriptorType::kU8;
  into.descriptor_dim = n == 0 ? 0 : 32;
  into.descriptors = buffer_.descriptors;
  into.word_id.assign(n, -1);
  for (auto* column : {&into.point_x, &into.point_y, &into.point_z}) column->assign(n, kUnknown);
  const Eigen::Isometry3d T_base_map = shared_->T_map_base(keyframe).inverse();
  for (std::size_t i = 0; i < n; ++i) {
    if (buffer_.landmark[i] < 0) continue;
    const std::array<double, 3>* const place = shared_->map.landmark(buffer_.landmark[i]);
    if (place == nullptr) continue;  // removed from the map after the keyframe saw it
    const Eigen::Vector3d p_base =
        T_base_map * shared_->alignment.into_map.point(Eigen::Vector3d(place->data()));
    into.word_id[i] = buffer_.landmark[i];
    into.point_x[i] = static_cast<float>(p_base.x());
    into.point_y[i] = static_cast<float>(p_base.y());
    into.point_z[i] = static_cast<float>(p_base.z());
  }
}

void StellaSource::read_links(const StellaKeyframe& keyframe, std::vector<Link>& into) const {
  std::vector<std::pair<std::int32_t, const StellaKeyframe*>> edges;  // type, to
  const auto add = [&](std::int32_t to, std::int32_t type) {
    const StellaKeyframe* const other = shared_->map.find(to);
    if (other != nullptr && !other->damage && to != keyframe.id) edges.emplace_back(type, other);
  };
  add(keyframe.span_parent, kNeighbourLink);
  for (const std::int32_t to : keyframe.loop_edges) add(to, kGlobalClosureLink);
  // Keyframes stand in order of id, so their places in memory order them.
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const Eigen::Isometry3d T_base_map = shared_->T_map_base(keyframe).inverse();
  for (const auto& [type, other] : edges) {
    Link& link = into.emplace_back();
    link.to = other->id;
    link.type = type;
    link.transform = transform_of(T_base_map * shared_->T_map_base(*other));
  }
}

}  // namespace zonepack::packer
