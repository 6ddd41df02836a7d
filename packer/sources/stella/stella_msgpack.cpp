// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/stella/stella_msgpack.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "packer/sources/stella/msgpack_walk.hpp"
#include "platform/base/file_kind.hpp"

namespace zonepack::packer {
namespace {

constexpr std::size_t kWordsPerDescriptor = 8;
constexpr std::size_t kMostKeypoints = 1'000'000;
constexpr std::size_t kMostCameras = 1000;
constexpr std::uint64_t kNoParent = 4294967295U;

// What a file holds of a keyframe, while it is read.
struct Draft {
  StellaKeyframe keyframe;
  StellaFeatures features;
  std::vector<float> distorted_angle;  // of 2019's keypts, whose undists are points only
  std::vector<std::int32_t> distorted_octave;
  std::array<double, 4> rot_cw{};  // x, y, z, w
  std::array<double, 3> trans_cw{};
  std::size_t descriptor_words = 0;
  bool has_stamp = false, has_camera = false, has_rotation = false, has_place = false,
       has_count = false, counted_too_many = false, odd_descriptor = false;
  double scale_factor = 0;  // 2019's own
};

struct LandmarkDraft {
  std::array<double, 3> p{};
  std::size_t coordinates = 0;
};

class StellaSax : public MsgpackWalk {
 public:
  explicit StellaSax(const std::string& file) : MsgpackWalk(file) {}

  StellaMap map;
  std::vector<StellaFeatures> features;  // of map.keyframes
  bool has_keyframes = false, has_landmarks = false, has_cameras = false;

 private:
  void number(const Number& value) override {
    const std::string& part = key_at(0);
    if (part == "keyframes" && depth() >= 3) return keyframe_number(value);
    if (part == "landmarks" && depth() == 4 && key_at(2) == "pos_w") {
      if (index_at(3) < 3) landmark_.p[index_at(3)] = value.real;
      landmark_.coordinates = index_at(3) + 1;
    } else if (part == "cameras" && depth() == 3) {
      camera_number(value);
    } else if (part == "orb_params" && depth() == 3) {
      orb_number(value);
    }
  }

  void text(const std::string& value) override {
    const std::string& part = key_at(0);
    if (depth() != 3) return;
    const std::string& field = key_at(2);
    if (part == "cameras") {
      if (field == "setup_type") camera_.setup = value;
      if (field == "model_type") camera_.model = value;
    } else if (part == "keyframes") {
      if (field == "cam") {
        draft_.keyframe.camera = value;
        draft_.has_camera = true;
      }
      if (field == "orb_params") draft_.keyframe.orb = value;
    }
  }

  void opened() override {
    if (depth() == 2) {
      const std::string& part = key_at(0);
      has_cameras |= part == "cameras";
      has_keyframes |= part == "keyframes";
      has_landmarks |= part == "landmarks";
    }
    if (depth() != 3) return;
    draft_ = Draft();
    landmark_ = LandmarkDraft();
    camera_ = StellaCamera();
    orb_ = OrbParameters();
  }

  void closed() override {
    if (depth() == 5 && key_at(0) == "keyframes") descriptor_closed();
    if (depth() != 3) return;
    const std::string& part = key_at(0);
    if (part == "cameras") {
      if (map.cameras.size() == kMostCameras) fail("expected at most 1000 cameras, found more");
      map.cameras[key_at(1)] = camera_;
    } else if (part == "orb_params") {
      if (map.orb.size() == kMostCameras) fail("expected at most 1000 orb_params, found more");
      map.orb[key_at(1)] = orb_;
    } else if (part == "landmarks") {
      landmark_closed();
    } else if (part == "keyframes") {
      keyframe_closed();
    }
  }

  std::int32_t id_of(const std::string& part) {
    const std::string& text = key_at(1);
    std::int32_t id = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
    if (error != std::errc() || end != text.data() + text.size() || id < 0) {
      fail(part + ": holds the id '" + text.substr(0, 40) +
           "', expected whole numbers from 0 to 2147483647");
    }
    return id;
  }

  void camera_number(const Number& value) {
    const std::string& field = key_at(2);
    static constexpr std::array<std::string_view, 6> kDistortion = {"k1", "k2", "p1",
                                                                    "p2", "k3", "k4"};
    if (field == "cols") camera_.cols = static_cast<std::int32_t>(std::clamp(value.real, 0.0, 1e9));
    if (field == "rows") camera_.rows = static_cast<std::int32_t>(std::clamp(value.real, 0.0, 1e9));
    if (field == "fx") camera_.fx = value.real;
    if (field == "fy") camera_.fy = value.real;
    if (field == "cx") camera_.cx = value.real;
    if (field == "cy") camera_.cy = value.real;
    if (field == "focal_x_baseline") camera_.focal_x_baseline = value.real;
    const auto at = std::ranges::find(kDistortion, field);
    if (at != kDistortion.end()) {
      camera_.k1_k2_p1_p2_k3_k4[static_cast<std::size_t>(at - kDistortion.begin())] = value.real;
    }
  }

  void orb_number(const Number& value) {
    const std::string& field = key_at(2);
    const auto whole = [&value] { return static_cast<int>(std::clamp(value.real, 0.0, 255.0)); };
    if (field == "scale_factor" && value.real >= 1 && value.real <= 8)
      orb_.scale_factor = value.real;
    if (field == "num_levels") orb_.levels = whole();
    if (field == "ini_fast_threshold") orb_.ini_threshold = whole();
    if (field == "min_fast_threshold") orb_.min_threshold = whole();
  }

  void landmark_closed() {
    const std::int32_t id = id_of("landmarks");
    const auto& p = landmark_.p;
    if (landmark_.coordinates != 3 || !std::isfinite(p[0]) || !std::isfinite(p[1]) ||
        !std::isfinite(p[2])) {
      ++landmarks_without_place_;
      if (landmarks_without_place_ > 1) map.warnings.pop_back();
      map.warnings.push_back(file() + ": landmarks: " + std::to_string(landmarks_without_place_) +
                             " have no place (expected pos_w of 3 numbers); their keypoints have "
                             "no point");
      return;
    }
    map.landmark_ids.push_back(id);
    map.landmarks.push_back(p);
  }

  void keyframe_number(const Number& value) {
    const std::string& field = key_at(2);
    StellaFeatures& f = draft_.features;
    if (depth() == 3) {
      if (field == "ts") {
        draft_.keyframe.stamp_s = value.real;
        draft_.has_stamp = true;
      } else if (field == "n_keypts") {
        draft_.has_count = value.real >= 0 && value.real <= static_cast<double>(kMostKeypoints);
        draft_.counted_too_many = !draft_.has_count;
        if (draft_.has_count) draft_.keyframe.keypoints = static_cast<std::size_t>(value.real);
      } else if (field == "span_parent") {
        const bool some = value.whole && value.integer >= 0 && value.integer < 2147483648;
        draft_.keyframe.span_parent = some ? static_cast<std::int32_t>(value.integer) : -1;
      } else if (field == "scale_factor") {
        draft_.scale_factor = value.real;
      }
      return;
    }
    if (depth() == 4) {
      if (field == "rot_cw" && index_at(3) < 4) {
        draft_.rot_cw[index_at(3)] = value.real;
        draft_.has_rotation = index_at(3) == 3;
      } else if (field == "trans_cw" && index_at(3) < 3) {
        draft_.trans_cw[index_at(3)] = value.real;
        draft_.has_place = index_at(3) == 2;
      } else if (field == "lm_ids") {
        f.landmark.push_back(id_value(value));
      } else if (field == "loop_edges") {
        draft_.keyframe.loop_edges.push_back(id_value(value));
      }
      return;
    }
    if (field == "descs" && depth() == 5) {
      if (index_at(4) == 0) draft_.descriptor_words = 0;
      descriptor_word(value);
    } else if (field == "undists" && depth() == 5) {
      point(index_at(4), value);
    } else if (field == "undist_keypts" || field == "keypts" || field == "undists") {
      keypoint_number(field, value);
    }
  }

  static std::int32_t id_value(const Number& value) {
    const bool some = value.whole && value.integer >= 0 && value.integer < 2147483648;
    return some ? static_cast<std::int32_t>(value.integer) : -1;
  }

  void point(std::size_t coordinate, const Number& value) {
    StellaFeatures& f = draft_.features;
    if (coordinate == 0) f.x.push_back(static_cast<float>(value.real));
    if (coordinate == 1) f.y.push_back(static_cast<float>(value.real));
  }

  void keypoint_number(const std::string& field, const Number& value) {
    StellaFeatures& f = draft_.features;
    const bool distorted = field == "keypts";
    if (depth() == 6) {
      if (!distorted && key_at(4) == "pt") point(index_at(5), value);
      return;
    }
    if (depth() != 5) return;
    if (key_at(4) == "ang") {
      (distorted ? draft_.distorted_angle : f.angle).push_back(static_cast<float>(value.real));
    } else if (key_at(4) == "oct") {
      const double octave = std::clamp(value.real, -1.0, 255.0);
      (distorted ? draft_.distorted_octave : f.octave).push_back(static_cast<std::int32_t>(octave));
    }
  }

  void descriptor_word(const Number& value) {
    const bool word = value.whole && value.integer >= 0 && value.integer <= 4294967295LL;
    draft_.odd_descriptor |= !word;
    const auto bits = word ? static_cast<std::uint32_t>(value.integer) : 0U;
    for (int shift = 0; shift < 32; shift += 8) {
      draft_.features.descriptors.push_back(static_cast<std::byte>(bits >> shift));
    }
    ++draft_.descriptor_words;
  }

  void descriptor_closed() {
    if (key_at(2) != "descs") return;
    draft_.odd_descriptor |= draft_.descriptor_words != kWordsPerDescriptor;
    draft_.descriptor_words = 0;
  }

  void keyframe_closed() {
    StellaKeyframe& keyframe = draft_.keyframe;
    keyframe.id = id_of("keyframes");
    if (!draft_.has_stamp || !draft_.has_camera || !draft_.has_rotation || !draft_.has_place) {
      fail("keyframe " + key_at(1) + ": expected ts, cam, rot_cw of 4 and trans_cw of 3 numbers");
    }
    try {
      finish_keyframe({&file(), keyframe.id, "keyframes"});
    } catch (const DamagedSignature& error) {
      keyframe.damage = error.damage();
    } catch (const std::runtime_error& error) {  // keyframe 0, which CellPlace takes for none
      if (keyframe.id != 0) throw;
      keyframe.damage = Damage{0, "keyframes", error.what()};
    }
    if (keyframe.damage) draft_.features = StellaFeatures();
    map.features += keyframe.damage ? 0 : keyframe.keypoints;
    map.keyframes.push_back(std::move(keyframe));
    features.push_back(std::move(draft_.features));
  }

  void finish_keyframe(const CellPlace& place) {
    StellaKeyframe& keyframe = draft_.keyframe;
    const auto& q = draft_.rot_cw;
    const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
    const double length = rotation.norm();
    if (!(length > 0.99 && length < 1.01)) {
      place.at("rot_cw").damaged("expected a rotation x, y, z, w of length 1, found one of " +
                                 std::to_string(length));
    }
    keyframe.T_camera_world =
        Eigen::Translation3d(draft_.trans_cw[0], draft_.trans_cw[1], draft_.trans_cw[2]) *
        rotation.normalized();
    require_camera_pose(keyframe.T_camera_world, place.at("trans_cw"));
    if (draft_.counted_too_many) place.at("n_keypts").damaged("expected 0 to 1000000");
    StellaFeatures& f = draft_.features;
    if (f.angle.empty()) f.angle = std::move(draft_.distorted_angle);
    if (f.octave.empty()) f.octave = std::move(draft_.distorted_octave);
    if (!draft_.has_count) keyframe.keypoints = f.x.size();
    const std::size_t n = keyframe.keypoints;
    const auto require = [&](const char* name, std::size_t found) {
      if (found == n) return;
      place.at(name).damaged("expected " + std::to_string(n) + ", as n_keypts says, found " +
                             std::to_string(found));
    };
    require("undist_keypts.pt", f.x.size());
    require("undist_keypts.pt", f.y.size());
    require("undist_keypts.ang", f.angle.size());
    require("undist_keypts.oct", f.octave.size());
    require("lm_ids", f.landmark.size());
    require("descs", f.descriptors.size() / 32);
    if (draft_.odd_descriptor) place.at("descs").damaged("expected 8 numbers of 32 bits each");
    if (draft_.scale_factor >= 1 && draft_.scale_factor <= 8 && keyframe.orb.empty()) {
      map.version = "msgpack 2019";
      keyframe.orb = "scale factor " + std::to_string(draft_.scale_factor);
      map.orb[keyframe.orb].scale_factor = draft_.scale_factor;
    }
    f.response.assign(n, 0.0F);
    f.size.resize(n);
  }

  Draft draft_;
  LandmarkDraft landmark_;
  StellaCamera camera_;
  OrbParameters orb_;
  std::size_t landmarks_without_place_ = 0;
};

class MemoryFeatures : public StellaFeatureReader {
 public:
  using ById = std::map<std::int32_t, StellaFeatures>;
  explicit MemoryFeatures(std::shared_ptr<const ById> features) : features_(std::move(features)) {}

  std::unique_ptr<StellaFeatureReader> reopen() const override {
    return std::make_unique<MemoryFeatures>(features_);
  }
  void require_unchanged() const override {}  // all of it is in memory
  void read(const StellaKeyframe& keyframe, StellaFeatures& into) override {
    into = features_->at(keyframe.id);
  }

 private:
  std::shared_ptr<const ById> features_;
};

}  // namespace

bool begins_as_stella_msgpack(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::array<char, 64> bytes{};
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), bytes.size());
  std::string_view rest(bytes.data(),
                        static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  if (rest.empty()) return false;
  const auto first = static_cast<unsigned char>(rest[0]);
  const std::size_t head = first >= 0x80 && first <= 0x8F ? 1
                           : first == 0xDE                ? 3
                           : first == 0xDF                ? 5
                                                          : 0;
  if (head == 0 || rest.size() <= head + 1) return false;
  rest.remove_prefix(head);
  const auto length =
      static_cast<unsigned char>(rest[0]);  // of a short string: 0xA0 and its length
  if (length < 0xA0 || length > 0xBF) return false;
  const std::string_view key = rest.substr(1, length & 0x1FU);
  static constexpr std::array<std::string_view, 7> kKeys = {
      "cameras",       "orb_params",       "keyframes",       "landmarks",
      "frame_next_id", "keyframe_next_id", "landmark_next_id"};
  return std::ranges::find(kKeys, key) != kKeys.end();
}

StellaFile open_stella_msgpack(const std::filesystem::path& path) {
  const std::string name = path.string();
  StellaSax sax(name);
  sax.map.version = "msgpack";
  sax.walk(path);
  if (!sax.has_cameras || !sax.has_keyframes || !sax.has_landmarks) {
    throw std::runtime_error(name +
                             ": is no map of stella_vslam: expected the keys cameras, "
                             "keyframes and landmarks");
  }
  auto by_id = std::make_shared<MemoryFeatures::ById>();
  for (std::size_t i = 0; i < sax.map.keyframes.size(); ++i) {
    const StellaKeyframe& keyframe = sax.map.keyframes[i];
    StellaFeatures& f = sax.features[i];
    const OrbParameters orb = sax.map.orb_of(keyframe);
    for (std::size_t k = 0; k < f.octave.size(); ++k) f.size[k] = keypoint_size(orb, f.octave[k]);
    by_id->emplace(keyframe.id, std::move(f));
  }
  StellaFile out;
  out.map = std::move(sax.map);
  sort_by_id(out.map, name);
  out.map.feature_bytes = out.map.features * 64 + out.map.landmarks.size() * 24;
  out.features = std::make_unique<MemoryFeatures>(std::move(by_id));
  return out;
}

}  // namespace zonepack::packer
