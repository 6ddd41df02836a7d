// SPDX-License-Identifier: Apache-2.0
// usage: localize_queries MAP MISSION [OPTION=VALUE...]: one fix for each image of a mission, from
// a prior that is the truth with noise, every zone resident.
//
// MISSION holds rgb.txt, calibration.yaml and base_groundtruth.txt. Options: position=0.3 (metres,
// standard deviation along each axis), yaw=5 (degrees), seed=1, false=N (that many trials with a
// prior at a signature elsewhere), roll=, pitch= (degrees by which the camera is tilted, unknown
// to the localizer), z= (metres by which it is lower), change=gain:2.5 and others
// (image_changes.hpp), every=N (only each N-th image), lost=1 (no prior), list=1 (a line for each
// image), needed=8, json=FILE.
//
// Prints the share of right fixes (within 0.5 m and 10 degrees of the truth), wrong ones, errors to
// the truth and in the map's frame (the truth moved by the own error of the signature nearest in
// place and view, a radian as a metre), and thread-CPU times.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "platform/process/clock.hpp"
#include "runtime/client/signature_view.hpp"
#include "runtime/localize/camera/calibration.hpp"
#include "runtime/localize/camera/image_file.hpp"
#include "runtime/localize/camera/image_list.hpp"
#include "runtime/localize/query/localizer.hpp"
#include "runtime/localize/query/stored_map.hpp"
#include "runtime/localize/replay/map_error.hpp"
#include "runtime/odometry/poses_apart.hpp"
#include "runtime/odometry/se2.hpp"
#include "runtime/pack_format/file/pack_reader.hpp"
#include "tests/support/image_changes.hpp"

namespace {

using namespace zonepack;
using namespace zonepack::localize;

constexpr double kDegree = std::numbers::pi / 180;

struct TruePose {
  double t_s;
  Pose2 pose;
};

std::vector<TruePose> read_truth(const std::string& file) {
  std::vector<TruePose> out;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    if (line.starts_with("#")) continue;
    std::istringstream words(line);
    double t = 0, x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 0;
    if (!(words >> t >> x >> y >> z >> qx >> qy >> qz >> qw)) continue;
    out.push_back({t, {x, y, 2 * std::atan2(qz, qw)}});
  }
  return out;
}

Pose2 truth_at(const std::vector<TruePose>& truth, double t_s) {
  const auto after = std::lower_bound(truth.begin(), truth.end(), t_s,
                                      [](const TruePose& a, double t) { return a.t_s < t; });
  if (after == truth.begin()) return truth.front().pose;
  if (after == truth.end()) return truth.back().pose;
  const TruePose& a = *(after - 1);
  const TruePose& b = *after;
  const double part = (t_s - a.t_s) / (b.t_s - a.t_s);
  return {a.pose.x_m + part * (b.pose.x_m - a.pose.x_m),
          a.pose.y_m + part * (b.pose.y_m - a.pose.y_m),
          a.pose.yaw_rad + part * turn_rad(a.pose.yaw_rad, b.pose.yaw_rad)};
}

double percentile(std::vector<double> values, double p) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(p * static_cast<double>(values.size() - 1) + 0.5)];
}

[[noreturn]] void stop(const std::string& message) {
  std::fprintf(stderr, "localize_queries: %s\n", message.c_str());
  std::exit(1);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) stop("usage: localize_queries MAP MISSION [OPTION=VALUE...]");
  std::map<std::string, std::string> options{
      {"position", "0.3"}, {"yaw", "5"},    {"seed", "1"},      {"false", "0"}, {"roll", "0"},
      {"pitch", "0"},      {"z", "0"},      {"change", "none"}, {"every", "1"}, {"lost", "0"},
      {"list", "0"},       {"needed", "8"}, {"json", ""}};
  for (int i = 3; i < argc; ++i) {
    const std::string word = argv[i];
    const std::size_t equal = word.find('=');
    if (equal == std::string::npos || !options.contains(word.substr(0, equal))) {
      stop("unknown option " + word);
    }
    options[word.substr(0, equal)] = word.substr(equal + 1);
  }
  const auto number = [&](const char* name) { return std::atof(options[name].c_str()); };
  const std::string mission = argv[2];
  auto calibration = read_calibration(mission + "/calibration.yaml");
  if (!calibration) stop(calibration.error().message);
  CameraModel camera = *calibration;
  camera.T_base_camera.linear() =
      (Eigen::AngleAxisd(number("roll") * kDegree, Eigen::Vector3d::UnitX()) *
       Eigen::AngleAxisd(number("pitch") * kDegree, Eigen::Vector3d::UnitY()))
          .toRotationMatrix() *
      camera.T_base_camera.linear();
  camera.T_base_camera.translation().z() += number("z");
  const auto images = read_image_list(mission + "/rgb.txt");
  if (!images) stop(images.error().message);
  const std::vector<TruePose> truth = read_truth(mission + "/base_groundtruth.txt");
  if (truth.empty()) stop(mission + "/base_groundtruth.txt: no poses");
  const auto map = open_stored_map(argv[1]);
  if (!map) stop(map.error().message);
  std::vector<MapFeatures> signatures;
  for (ZoneId zone = 0; zone < map->catalog.zones.size(); ++zone) {
    auto some = read_zone_features(*map, zone);
    if (!some) stop(some.error().message);
    for (MapFeatures& one : *some) signatures.push_back(std::move(one));
  }
  std::vector<const MapFeatures*> resident;
  for (const MapFeatures& one : signatures) resident.push_back(&one);
  const auto errors = MapError::read(*map);
  if (!errors) stop(errors.error().message);
  const auto in_map_frame = [&](const Pose2& true_pose, double metres_a_radian) {
    return errors->in_map(true_pose, metres_a_radian).value_or(true_pose);
  };

  QueryOptions query;
  query.needed = std::atoi(options["needed"].c_str());
  Localizer localizer(camera, map->detector, query);
  std::mt19937 random(static_cast<std::uint32_t>(number("seed")));
  std::normal_distribution<double> normal(0, 1);
  const double position = number("position"), yaw = number("yaw") * kDegree;
  const Covariance2 covariance{position * position, 0, 0, position * position, 0, yaw * yaw};
  const bool lost = number("lost") != 0;
  int total = 0, right = 0, wrong = 0;
  std::vector<double> any_way;  // as to_map, by the nearest signature wherever it looks
  std::vector<double> rest_ms;  // without the detector
  std::vector<double> to_truth, to_map, yaw_error, all_ms, sigma_ratio;
  std::vector<std::vector<double>> stage_ms(kStages);
  std::map<std::string, int> reasons;
  std::vector<ImageFeatures> kept;
  std::vector<GreyImage> kept_images;
  std::vector<Pose2> kept_truth;
  const auto every = static_cast<std::size_t>(number("every"));
  for (std::size_t i = 0; i < images->size(); i += every) {
    const auto image = read_image((*images)[i].file);
    if (!image) stop(image.error().message);
    const auto seen =
        test_support::changed(*image, options["change"], static_cast<std::uint32_t>(i));
    if (!seen) stop("change: unknown word");
    const Pose2 true_pose = truth_at(truth, static_cast<double>((*images)[i].stamp_ns) / 1e9);
    QueryPrior prior{true_pose, covariance};
    prior.T_map_base.x_m += position * normal(random);
    prior.T_map_base.y_m += position * normal(random);
    prior.T_map_base.yaw_rad += yaw * normal(random);
    const QueryResult result =
        lost ? localizer.query(*seen, resident, {}) : localizer.query(*seen, resident, prior);
    ++total;
    ++reasons[to_string(result.reason)];
    all_ms.push_back(static_cast<double>(result.cpu_total_ns) / 1e6);
    rest_ms.push_back(static_cast<double>(result.cpu_total_ns - result.cpu_ns[0]) / 1e6);
    for (std::size_t k = 0; k < kStages; ++k) {
      stage_ms[k].push_back(static_cast<double>(result.cpu_ns[k]) / 1e6);
    }
    const Pose2 here = in_map_frame(true_pose, 1);
    const double off = apart_m(result.pose, true_pose);
    const double turned = std::abs(turn_rad(true_pose.yaw_rad, result.pose.yaw_rad));
    if (result.accepted) {
      const bool good = off <= 0.5 && turned <= 10 * kDegree;
      good ? ++right : ++wrong;
      to_truth.push_back(off);
      to_map.push_back(apart_m(result.pose, here));
      any_way.push_back(apart_m(result.pose, in_map_frame(true_pose, 0)));
      yaw_error.push_back(turned / kDegree);
      sigma_ratio.push_back(apart_m(result.pose, here) /
                            std::max(1e-9, position_sigma_m(result.covariance)));
    }
    if (number("list") != 0) {
      std::printf(
          "%s %s matches %d inliers %d distinct %d cells %d visible %d of %d off %.3f m "
          "%.2f deg map %.3f rms %.2f evidence %.1f sigma %.3f recognised %d of %d\n",
          (*images)[i].file.substr((*images)[i].file.rfind('/') + 1).c_str(),
          to_string(result.reason), result.matches, result.inliers, result.distinct, result.cells,
          result.visible, result.features, result.found ? off : -1, turned / kDegree,
          apart_m(result.pose, here), result.residual_px, result.evidence,
          position_sigma_m(result.covariance), result.recognised, result.looked_at);
    }
    if (number("false") > 0) {
      if (auto features = localizer.detect(*seen)) {
        kept.push_back(std::move(*features));
        kept_images.push_back(*seen);
        kept_truth.push_back(true_pose);
      }
    }
  }
  std::printf(
      "%-34s images %d right %.3f wrong %d  truth cm %.1f %.1f max %.1f  map cm %.2f %.2f  "
      "yaw deg %.2f  off/sigma %.1f  ms %.1f %.1f",
      (mission.substr(mission.rfind('/') + 1) + " " + options["change"]).c_str(), total,
      static_cast<double>(right) / total, wrong, 100 * percentile(to_truth, 0.5),
      100 * percentile(to_truth, 0.95), 100 * percentile(to_truth, 1),
      100 * percentile(to_map, 0.5), 100 * percentile(to_map, 0.95), percentile(yaw_error, 0.95),
      percentile(sigma_ratio, 0.95), percentile(all_ms, 0.5), percentile(all_ms, 0.95));
  for (std::size_t k = 0; k < kStages; ++k) {
    std::printf(" %s %.1f", to_string(static_cast<Stage>(k)), percentile(stage_ms[k], 0.5));
  }
  for (const auto& [name, count] : reasons) std::printf(" %s:%d", name.c_str(), count);
  std::printf("\n");
  int accepted_falsely = 0;
  if (number("false") > 0) {
    int accepted = 0;
    const int trials = static_cast<int>(number("false"));
    for (int trial = 0; trial < trials;) {
      const std::size_t image = random() % kept.size();
      const MapFeatures& place = signatures[random() % signatures.size()];
      const Pose2 at{place.T_map_base.translation().x(), place.T_map_base.translation().y(),
                     std::atan2(place.T_map_base.linear()(1, 0), place.T_map_base.linear()(0, 0))};
      if (apart_m(at, kept_truth[image]) < 5) continue;
      ++trial;
      const QueryResult result =
          localizer.locate(kept[image], resident, QueryPrior{at, covariance}, &kept_images[image]);
      if (result.accepted) {
        ++accepted;
        std::printf(
            "accepted at %.2f %.2f, %d distinct in %d cells, %d of %d visible evidence %.1f sigma "
            "%.3f\n",
            result.pose.x_m, result.pose.y_m, result.distinct, result.cells, result.visible,
            result.features, result.evidence, position_sigma_m(result.covariance));
      }
    }
    std::printf("false priors: %d of %d accepted\n", accepted, trials);
    accepted_falsely = accepted;
  }
  if (!options["json"].empty()) {
    std::ofstream out(options["json"]);
    out << "{\"images\": " << total << ", \"right\": " << static_cast<double>(right) / total
        << ", \"wrong\": " << wrong << ", \"false_accepted\": " << accepted_falsely
        << ", \"map_p50_cm\": " << 100 * percentile(to_map, 0.5)
        << ", \"map_p95_cm\": " << 100 * percentile(to_map, 0.95)
        << ", \"any_way_p50_cm\": " << 100 * percentile(any_way, 0.5)
        << ", \"any_way_p95_cm\": " << 100 * percentile(any_way, 0.95)
        << ", \"query_p95_ms\": " << percentile(all_ms, 0.95)
        << ", \"rest_p95_ms\": " << percentile(rest_ms, 0.95) << "}\n";
    if (!out.flush()) stop("cannot write " + options["json"]);
  }
  return 0;
}
