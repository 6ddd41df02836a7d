// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/explain/query_command.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/base/json_text.hpp"
#include "platform/base/shell_word.hpp"
#include "platform/files/write_output.hpp"
#include "runtime/localize/camera/calibration.hpp"
#include "runtime/localize/camera/image_file.hpp"
#include "runtime/localize/explain/query_drawing.hpp"
#include "runtime/localize/explain/query_reason.hpp"
#include "runtime/localize/query/localizer.hpp"
#include "runtime/localize/query/stored_map.hpp"
#include "runtime/odometry/se2.hpp"
#include "runtime/report/report.hpp"

namespace zonepack::localize {
namespace {

// How well a person knows where the robot stands: one standard deviation.
constexpr double kNear_m = 0.3, kNear_rad = 5 * kDegreeInRad;

std::string digits_of(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string pose_text(const Pose2& pose) {
  return digits_of(pose.x_m, 3) + "," + digits_of(pose.y_m, 3) + "," +
         digits_of(pose.yaw_rad / kDegreeInRad, 2);
}

struct Answer {
  QueryResult result;
  QueryAsked asked;
  std::string why;
  std::string best_zone;  // by name
};

std::string json_of(const Answer& answer) {
  const QueryResult& r = answer.result;
  const auto field = [](const std::string& key, const std::string& value) {
    return "\"" + key + "\": " + value;
  };
  std::string out = "{\n  " + field("accepted", r.accepted ? "true" : "false");
  const auto add = [&](const std::string& key, const std::string& value) {
    out += ",\n  " + field(key, value);
  };
  add("reason", json_quoted(to_string(r.reason)));
  add("why", json_quoted(answer.why));
  const auto degrees = [](double rad) { return digits_of(rad / kDegreeInRad, 3); };
  add("pose", !r.found ? "null"
                       : "{\"x_m\": " + digits_of(r.pose.x_m, 4) +
                             ", \"y_m\": " + digits_of(r.pose.y_m, 4) +
                             ", \"yaw_deg\": " + degrees(r.pose.yaw_rad) +
                             ", \"z_m\": " + digits_of(r.T_map_base.translation().z(), 4) + "}");
  const Covariance2& c = r.covariance;
  add("sigma", !r.found ? "null"
                        : "{\"x_m\": " + digits_of(std::sqrt(c.xx), 4) +
                              ", \"y_m\": " + digits_of(std::sqrt(c.yy), 4) +
                              ", \"yaw_deg\": " + degrees(std::sqrt(c.yaw_yaw)) + "}");
  add("features", std::to_string(r.features));
  add("matches", std::to_string(r.matches));
  add("inliers", std::to_string(r.inliers));
  add("distinct", std::to_string(r.distinct));
  add("needed", std::to_string(answer.asked.needed));
  add("cells", std::to_string(r.cells));
  add("visible", std::to_string(r.visible));
  add("evidence", digits_of(r.evidence, 2));
  add("places_found", std::to_string(r.places_found));
  add("looked_at", std::to_string(r.looked_at));
  add("recognised", std::to_string(r.recognised));
  add("residual_px", digits_of(r.residual_px, 3));
  add("signatures", std::to_string(r.signatures));
  add("best_signature", r.found ? std::to_string(r.best) : "null");
  add("best_zone", r.found ? json_quoted(answer.best_zone) : "null");
  add("nearest", !answer.asked.with_prior || r.nearest == 0
                     ? "null"
                     : "{\"signature\": " + std::to_string(r.nearest) +
                           ", \"zone\": " + json_quoted(answer.asked.nearest_zone) +
                           ", \"distance_m\": " + digits_of(r.nearest_m, 3) +
                           ", \"turned_deg\": " + degrees(r.nearest_turn_rad) + "}");
  std::string stages = "{\"all\": " + digits_of(static_cast<double>(r.cpu_total_ns) / 1e6, 3);
  for (std::size_t i = 0; i < kStages; ++i) {
    stages += std::string(", \"") + to_string(static_cast<Stage>(i)) +
              "\": " + digits_of(static_cast<double>(r.cpu_ns[i]) / 1e6, 3);
  }
  add("query_ms", stages + "}");
  return out + "\n}\n";
}

std::string text_of(const Answer& answer) {
  const QueryResult& r = answer.result;
  std::string out;
  if (r.accepted) {
    out = pose_text(r.pose) + " (x, y in metres, yaw in degrees), +- " +
          digits_of(100 * position_sigma_m(r.covariance), 1) + " cm and " +
          digits_of(std::sqrt(r.covariance.yaw_yaw) / kDegreeInRad, 2) + " degrees, in sight of " +
          answer.best_zone + "\n";
  } else {
    out = std::string("no pose: ") + to_string(r.reason) + "\n";
  }
  return out + answer.why + "\n";
}

report::Report report_of(const QueryArguments& arguments, const Answer& answer,
                         const GreyImage& image, const StoredMap& map,
                         const std::vector<MapFeatures>& features) {
  const QueryResult& r = answer.result;
  report::Report out;
  out.title = r.accepted ? "Where " + arguments.image + " was taken"
                         : "Why " + arguments.image + " gives no pose";
  out.headline = (r.accepted ? pose_text(r.pose) + ": " : std::string()) + answer.why + ".";
  out.origin = arguments.map + ", " + arguments.calibration;
  out.facts = {{"features", std::to_string(r.features), "in the image", false},
               {"matches", std::to_string(r.matches), "with points of the map", false},
               {"agree", std::to_string(r.distinct),
                "distinct ones; " + std::to_string(answer.asked.needed) + " are needed",
                r.distinct < answer.asked.needed},
               {"parts", std::to_string(r.cells), "of 16 of the image hold one",
                r.cells < answer.asked.needed_cells}};
  out.figures.push_back({"The image",
                         "Green: matches that agree, with the place of the map's point (orange). "
                         "Red: matches that do not.",
                         draw_matches(image, r)});
  out.figures.push_back({"The place",
                         "Signatures with their direction, green where they gave a match; orange: "
                         "matched points. Filled: the pose that was found. Blue outline: where the "
                         "robot was said to be.",
                         draw_place(map.catalog, features, r, arguments.place.near)});
  return out;
}

// The zones that are looked at: one, or all.
Outcome<std::vector<MapFeatures>> features_of(const StoredMap& map, const std::string& zone) {
  std::vector<MapFeatures> out;
  if (!zone.empty() && map.catalog.find(zone) == kNoZone) {
    return failure(map.catalog.folder + ": has no zone '" + zone + "'; zonepack inspect " +
                   shell_word(map.catalog.folder) + " lists them");
  }
  for (ZoneId id = 0; id < map.catalog.zones.size(); ++id) {
    if (!zone.empty() && map.catalog.zones[id].name != zone) continue;
    auto some = read_zone_features(map, id);
    if (!some) return std::move(some).error();
    for (MapFeatures& one : *some) out.push_back(std::move(one));
  }
  return out;
}

Outcome<void> query(const QueryArguments& arguments) {
  if (!arguments.draw.empty()) {
    if (auto name = report::check_report_name(arguments.draw); !name) return name;
  }
  const auto camera = read_calibration(arguments.calibration);
  if (!camera) return camera.error();
  const auto image = read_image(arguments.image);
  if (!image) return image.error();
  if (image->width != camera->width || image->height != camera->height) {
    return failure(arguments.image + ": has " + std::to_string(image->width) + "x" +
                   std::to_string(image->height) + " pixels, but " + arguments.calibration +
                   " is of " + std::to_string(camera->width) + "x" +
                   std::to_string(camera->height) + "; give the calibration of this camera");
  }
  const auto map = open_stored_map(arguments.map);
  if (!map) return map.error();
  const auto features = features_of(*map, arguments.place.zone);
  if (!features) return features.error();
  std::vector<const MapFeatures*> all;
  for (const MapFeatures& one : *features) all.push_back(&one);

  QueryOptions options;
  options.keep_matches = !arguments.draw.empty();
  Localizer localizer(*camera, map->detector, options);
  std::optional<QueryPrior> prior;
  if (arguments.place.near) {
    prior = QueryPrior{*arguments.place.near,
                       {kNear_m * kNear_m, 0, 0, kNear_m * kNear_m, 0, kNear_rad * kNear_rad}};
  }
  Answer answer;
  answer.result = localizer.query(*image, all, prior);
  const auto name_of = [&](ZoneId zone) {
    return zone < map->catalog.zones.size() ? map->catalog.zones[zone].name : std::string();
  };
  answer.asked = {*camera,
                  image->width,
                  image->height,
                  options.needed,
                  options.needed_cells,
                  prior.has_value(),
                  name_of(answer.result.nearest_zone)};
  answer.best_zone = name_of(answer.result.best_zone);
  answer.why = query_reason(answer.result, answer.asked);
  std::fputs(text_of(answer).c_str(), arguments.json == "-" ? stderr : stdout);
  if (!arguments.json.empty()) {
    if (auto written = write_output(arguments.json, json_of(answer)); !written) return written;
  }
  if (!arguments.draw.empty()) {
    return report::write_report(arguments.draw,
                                report_of(arguments, answer, *image, *map, *features));
  }
  return {};
}

}  // namespace

int run_query(const QueryArguments& arguments) {
  const auto done = query(arguments);
  return done ? 0 : report_failure("zoneloc", done.error());
}

}  // namespace zonepack::localize
