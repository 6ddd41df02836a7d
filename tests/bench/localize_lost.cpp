// SPDX-License-Identifier: Apache-2.0
// usage: localize_lost MAP MISSION CONFIG [OPTION=VALUE...]: how soon a lost robot is found, with
// every image of a mission as a start and all images after it as views.
//
// MISSION holds rgb.txt, calibration.yaml, base_groundtruth.txt and can0.log; CONFIG is the robot's
// settings, for its wheels. Options: most=20 (views of a start), every=N (only each N-th image as a
// start), cut=1 (zones that have a signature in view of one of the start's views are taken out of
// the map: nothing may be found), list=1 (a line for each start), json=FILE (the figures, too),
// cache=FILE (keeps what was matched, for the next run with the same map and mission), and the
// rule's least_distinct=, least_explained=, least_support=, most_rival=, against_costs=, chance=,
// should_see=; views=MAP (the signatures of another map of the building, or of the same with cut=1,
// are seen instead of the mission's images: a drive through every zone).
//
// Prints the share of starts found within 5, 10 and `most` views, the same of those starts within
// which the robot moved or turned as the rule demands, wrong ones (over 0.5 m or 10 degrees off the
// truth), and thread-CPU time of a view against the whole map.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "platform/can/can_log.hpp"
#include "platform/process/clock.hpp"
#include "runtime/localize/camera/calibration.hpp"
#include "runtime/localize/camera/image_file.hpp"
#include "runtime/localize/camera/image_list.hpp"
#include "runtime/localize/lost/lost_search.hpp"
#include "runtime/localize/query/candidates.hpp"
#include "runtime/localize/query/stored_map.hpp"
#include "runtime/localize/solve/sighting.hpp"
#include "runtime/odometry/se2.hpp"
#include "runtime/odometry/wheel_odometry.hpp"
#include "runtime/run/inputs/run_files.hpp"
#include "runtime/settings/settings.hpp"

namespace {

using namespace zonepack;
using namespace zonepack::localize;

[[noreturn]] void stop(const std::string& message) {
  std::fprintf(stderr, "localize_lost: %s\n", message.c_str());
  std::exit(1);
}

// Remembers what a matcher said: the same view comes in many starts.
class RememberingMatcher final : public PlaceMatcher {
 public:
  explicit RememberingMatcher(PlaceMatcher& inner) : inner_(inner) {}

  std::vector<Sight> guess(const LostView& view, ZoneId zone,
                           std::span<const MapFeatures* const> map) override {
    return remember({view.number, zone, {}}, [&] { return inner_.guess(view, zone, map); });
  }
  std::optional<Sight> check(const LostView& view, ZoneId zone,
                             std::span<const MapFeatures* const> map,
                             const QueryPrior& prior) override {
    const Pose2& at = prior.T_map_base;
    const auto all =
        remember({view.number, zone, {at.x_m, at.y_m, at.yaw_rad, prior.covariance.xx}}, [&] {
          const auto one = inner_.check(view, zone, map, prior);
          return one ? std::vector<Sight>{*one} : std::vector<Sight>{};
        });
    return all.empty() ? std::nullopt : std::optional(all.front());
  }
  void load(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    Key key;
    std::uint64_t count = 0;
    while (in.read(reinterpret_cast<char*>(&key), sizeof key) &&
           in.read(reinterpret_cast<char*>(&count), sizeof count)) {
      std::vector<Sight> sights(count);
      in.read(reinterpret_cast<char*>(sights.data()),
              static_cast<std::streamsize>(count * sizeof(Sight)));
      known_[key] = std::move(sights);
    }
  }
  void save(const std::string& file) const {
    std::ofstream out(file, std::ios::binary);
    for (const auto& [key, sights] : known_) {
      const std::uint64_t count = sights.size();
      out.write(reinterpret_cast<const char*>(&key), sizeof key);
      out.write(reinterpret_cast<const char*>(&count), sizeof count);
      out.write(reinterpret_cast<const char*>(sights.data()),
                static_cast<std::streamsize>(count * sizeof(Sight)));
    }
  }
  std::int64_t guess_ns = 0, check_ns = 0;
  std::size_t guesses = 0, checks = 0;

 private:
  struct Key {
    std::uint64_t view = 0;
    std::uint64_t zone = 0;
    std::array<double, 4> prior{};
    auto operator<=>(const Key&) const = default;
  };
  template <typename Fn>
  std::vector<Sight> remember(const Key& key, Fn&& fn) {
    const auto known = known_.find(key);
    if (known != known_.end()) return known->second;
    const std::int64_t begun = thread_cpu_ns();
    auto found = fn();
    const bool guessed = key.prior == std::array<double, 4>{};
    (guessed ? guess_ns : check_ns) += thread_cpu_ns() - begun;
    ++(guessed ? guesses : checks);
    return known_[key] = std::move(found);
  }
  PlaceMatcher& inner_;
  std::map<Key, std::vector<Sight>> known_;
};

// The path by the wheels alone, at each stamp.
std::vector<Pose2> by_wheels(const std::string& log_file, const std::string& config,
                             const std::vector<ListedImage>& images) {
  const auto loaded = load_usable_settings(config);
  if (!loaded) stop(loaded.error().message);
  const zonepack::Settings& settings = loaded->settings;
  CanLogReader log(log_file, settings.can.interface);
  if (const auto opened = log.open(); !opened) stop(log.explain(opened.error()));
  WheelOdometry odometry(settings.odometry.wheels);
  std::vector<Pose2> out;
  Pose2 now;
  while (const auto frame = log.next()) {
    while (out.size() < images.size() && images[out.size()].stamp_ns <= frame->stamp_ns) {
      out.push_back(now);
    }
    if (const auto step = odometry.take(*frame)) now = compose(now, step->motion.pose);
  }
  out.resize(images.size(), now);
  return out;
}

// The signature's features as this camera would have them of its image.
ImageFeatures view_of(const MapFeatures& map, const CameraModel& camera) {
  ImageFeatures out;
  out.width = camera.width;
  out.height = camera.height;
  out.descriptor_bytes = map.descriptor_bytes;
  std::vector<std::size_t> order(map.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return map.points[a].x_px < map.points[b].x_px;
  });
  const auto scale = static_cast<float>(map.fx_px > 0 ? camera.fx / map.fx_px : 1);
  for (const std::size_t row : order) {
    out.seen_px.emplace_back(map.points[row].x_px * scale, map.points[row].y_px * scale);
    out.px.push_back(out.seen_px.back());
    const auto from =
        map.descriptors.begin() + static_cast<std::ptrdiff_t>(row * map.descriptor_bytes);
    out.descriptors.insert(out.descriptors.end(), from, from + map.descriptor_bytes);
  }
  return out;
}

// Views from `start` on after which two of them are as far apart as the rule demands; 0: never.
std::size_t moves_after(const std::vector<LostView>& views, std::size_t start, std::size_t end,
                        const LostRule& rule) {
  for (std::size_t i = start; i < end; ++i) {
    for (std::size_t k = start; k < i; ++k) {
      const Pose2 step = between(views[k].T_wheels_base, views[i].T_wheels_base);
      if (std::hypot(step.x_m, step.y_m) >= rule.moved_m ||
          std::abs(step.yaw_rad) >= rule.turned_rad) {
        return i - start + 1;
      }
    }
  }
  return 0;
}

struct Zone {
  std::vector<MapFeatures> features;
  std::vector<const MapFeatures*> list;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) stop("usage: localize_lost MAP MISSION CONFIG [OPTION=VALUE...]");
  std::map<std::string, std::string> options{{"most", "20"}, {"every", "1"}, {"cut", "0"},
                                             {"list", "0"},  {"json", ""},   {"cache", ""},
                                             {"views", ""}};
  LostRule rule;
  for (int i = 4; i < argc; ++i) {
    const std::string word = argv[i];
    const std::size_t equal = word.find('=');
    if (equal == std::string::npos) stop("unknown option " + word);
    const std::string key = word.substr(0, equal), text = word.substr(equal + 1);
    const double value = std::atof(text.c_str());
    if (key == "least_distinct")
      rule.least_distinct = static_cast<int>(value);
    else if (key == "least_explained")
      rule.least_explained = value;
    else if (key == "least_support")
      rule.least_support = value;
    else if (key == "most_rival")
      rule.most_rival = value;
    else if (key == "against_costs")
      rule.against_costs = value;
    else if (key == "chance")
      rule.chance = value;
    else if (key == "should_see")
      rule.should_see = static_cast<int>(value);
    else if (options.contains(key))
      options[key] = text;
    else
      stop("unknown option " + word);
  }
  const auto number = [&](const char* name) { return std::atof(options[name].c_str()); };
  const std::string mission = argv[2];
  const auto camera = read_calibration(mission + "/calibration.yaml");
  if (!camera) stop(camera.error().message);
  const auto images = read_image_list(mission + "/rgb.txt");
  if (!images) stop(images.error().message);
  const auto truth = read_truth(mission + "/base_groundtruth.txt");
  if (!truth) stop(truth.error().message);
  const std::vector<Pose2> wheels = by_wheels(mission + "/can0.log", argv[3], *images);
  const auto map = open_stored_map(argv[1]);
  if (!map) stop(map.error().message);
  std::vector<Zone> zones(map->catalog.zones.size());
  std::vector<const MapFeatures*> whole;
  for (ZoneId zone = 0; zone < zones.size(); ++zone) {
    auto some = read_zone_features(*map, zone);
    if (!some) stop(some.error().message);
    zones[zone].features = std::move(*some);
    for (const MapFeatures& one : zones[zone].features) zones[zone].list.push_back(&one);
    whole.insert(whole.end(), zones[zone].list.begin(), zones[zone].list.end());
  }
  Localizer localizer(*camera, map->detector);
  ImageMatcher images_matcher(localizer, map->detector);
  RememberingMatcher matcher(images_matcher);
  if (!options["cache"].empty()) matcher.load(options["cache"]);

  std::vector<LostView> views;
  std::vector<std::optional<Pose2>> true_poses;
  if (!options["views"].empty()) {
    // The other map's signatures, seen as a camera's images: a drive through all of its zones.
    const auto other = open_stored_map(options["views"]);
    if (!other) stop(other.error().message);
    std::vector<MapFeatures> signatures;
    for (ZoneId zone = 0; zone < other->catalog.zones.size(); ++zone) {
      auto some = read_zone_features(*other, zone);
      if (!some) stop(some.error().message);
      for (MapFeatures& one : *some) signatures.push_back(std::move(one));
    }
    std::sort(signatures.begin(), signatures.end(),
              [](const MapFeatures& a, const MapFeatures& b) { return a.id < b.id; });
    for (const MapFeatures& one : signatures) {
      true_poses.emplace_back(flatten(one.T_map_base));
      views.push_back({views.size() + 1, static_cast<std::int64_t>(views.size()) * 1'000'000'000,
                       *true_poses.back(), view_of(one, *camera)});
    }
  } else {
    for (std::size_t i = 0; i < images->size(); ++i) {
      const auto image = read_image((*images)[i].file);
      if (!image) stop(image.error().message);
      auto features = localizer.detect(*image);
      if (!features) stop((*images)[i].file + ": wrong size");
      views.push_back({i + 1, (*images)[i].stamp_ns, wheels[i], std::move(*features)});
      true_poses.push_back(truth->at((*images)[i].stamp_ns));
    }
  }
  std::vector<std::set<ZoneId>> in_view;
  for (const auto& true_pose : true_poses) {
    auto& here = in_view.emplace_back();
    if (!true_pose) continue;
    const QueryPrior prior{*true_pose, {0.01, 0, 0, 0.01, 0, 0.001}};
    for (const Candidate& one : choose_candidates(whole, *camera, prior, 12).reach) {
      here.insert(one.map->zone);
    }
  }

  const auto most = static_cast<std::size_t>(number("most"));
  std::size_t starts = 0, wrong = 0;
  double most_wrong_support = 0;
  std::vector<std::size_t> found_after, moved_after;
  for (std::size_t start = 0; start < views.size();
       start += static_cast<std::size_t>(number("every"))) {
    const std::size_t end = std::min(views.size(), start + most);
    std::set<ZoneId> out;
    if (number("cut") != 0) {
      for (std::size_t i = start; i < end; ++i) out.insert(in_view[i].begin(), in_view[i].end());
    }
    LostSearch search(matcher, rule);
    std::optional<LostPlace> place;
    std::size_t after = 0;
    for (std::size_t i = start; i < end && after == 0; ++i) {
      if (!search.add(views[i])) continue;
      for (ZoneId zone = 0; zone < zones.size(); ++zone) {
        if (!out.contains(zone)) search.match(zone, zones[zone].list);
      }
      place = search.leading();
      if (place && search.found(*place)) after = i - start + 1;
    }
    ++starts;
    if (const std::size_t moved = moves_after(views, start, end, rule))
      moved_after.push_back(moved);
    double off_m = -1, off_deg = -1;
    bool is_wrong = false;
    if (place) {
      const LostView& view = search.views()[place->views.front()];
      const auto true_pose = true_poses[view.number - 1];
      if (true_pose) {
        const Pose2 off = between(*true_pose, place->sights.front().pose);
        off_m = std::hypot(off.x_m, off.y_m);
        off_deg = std::abs(off.yaw_rad) * 180 / std::numbers::pi;
        is_wrong = off_m > 0.5 || off_deg > 10;
      }
    }
    if (is_wrong && place->views.size() > 1) {
      most_wrong_support = std::max(most_wrong_support, place->support);
    }
    if (after > 0) {
      found_after.push_back(after);
      wrong += is_wrong ? 1 : 0;
    }
    if (number("list") != 0 || (after > 0 && (is_wrong || number("cut") != 0))) {
      std::printf("start %zu: %s after %zu of %zu", start + 1, after > 0 ? "found" : "nothing",
                  after, end - start);
      if (place) {
        std::printf(
            ", support %.0f of %zu views, against %d, rival %.0f, moved %.2f m, turned %.0f deg, "
            "off "
            "%.2f m %.1f deg:",
            place->support, place->views.size(), place->against, place->rival, place->moved_m,
            place->turned_rad * 180 / std::numbers::pi, off_m, off_deg);
        for (const Sight& sight : place->sights)
          std::printf(" %d/%d%s", sight.distinct, sight.visible, sight.accepted ? "+" : "");
      }
      std::printf("\n");
    }
    if (!options["cache"].empty() && start % 20 == 0) matcher.save(options["cache"]);
  }
  if (!options["cache"].empty()) matcher.save(options["cache"]);
  const auto at_most = [](const std::vector<std::size_t>& numbers, std::size_t limit) {
    return static_cast<double>(
        std::count_if(numbers.begin(), numbers.end(), [&](std::size_t n) { return n <= limit; }));
  };
  const auto within = [&](std::size_t count) {
    return at_most(found_after, count) / static_cast<double>(starts);
  };
  const auto of_moved = [&](std::size_t count) {
    return at_most(found_after, count) / std::max(1.0, at_most(moved_after, count));
  };
  const auto mean_ms = [](std::int64_t ns, std::size_t count) {
    return count == 0 ? 0 : static_cast<double>(ns) / 1e6 / static_cast<double>(count);
  };
  std::printf(
      "%-20s%s starts %zu found within 5 %.3f 10 %.3f %zu %.3f, of those that moved %.3f %.3f "
      "%.3f, "
      "wrong %zu, most support of a wrong "
      "place %.0f  ms of a view and a zone "
      "%.2f, of a second look %.2f (%zu, %zu)\n",
      mission.substr(mission.rfind('/') + 1).c_str(), number("cut") != 0 ? " cut" : "", starts,
      within(5), within(10), most, within(most), of_moved(5), of_moved(10), of_moved(most), wrong,
      most_wrong_support, mean_ms(matcher.guess_ns, matcher.guesses),
      mean_ms(matcher.check_ns, matcher.checks), matcher.guesses, matcher.checks);
  if (!options["json"].empty()) {
    std::ofstream json(options["json"]);
    json << "{\"starts\": " << starts << ", \"found\": {\"5\": " << within(5)
         << ", \"10\": " << within(10) << ", \"" << most << "\": " << within(most)
         << "}, \"found_of_moved\": {\"5\": " << of_moved(5) << ", \"10\": " << of_moved(10)
         << ", \"" << most << "\": " << of_moved(most) << "}, \"confirmed\": " << found_after.size()
         << ", \"wrong\": " << wrong << "}\n";
    if (!json.flush()) stop(options["json"] + ": cannot be written");
  }
  return 0;
}
