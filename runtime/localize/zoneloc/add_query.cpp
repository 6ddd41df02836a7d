// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/zoneloc/add_query.hpp"

#include "platform/command_line/command_line.hpp"
#include "runtime/run/inputs/run_start.hpp"

namespace zonepack::localize {

void add_query(CLI::App& app, QueryArguments& arguments, std::function<int()>& command) {
  CLI::App& query = *app.add_subcommand(
      "query", "finds where one image was taken, and says why when it does not");
  query.add_option("--map", arguments.map, "map folder")->type_name("DIR")->required();
  query.add_option("--image", arguments.image, "JPEG or PNG")->type_name("FILE")->required();
  query
      .add_option("--calibration", arguments.calibration,
                  "of the camera, and where it sits on the robot (YAML)")
      ->type_name("FILE")
      ->required();
  CLI::Option* const near =
      query
          .add_option_function<std::string>(
              "--near",
              [&arguments](const std::string& text) {
                arguments.place.near = parse_pose(text);
                if (!arguments.place.near) {
                  throw CLI::ValidationError(
                      "--near", "'" + text + "' is not X,Y,YAW_DEG in metres and degrees");
                }
              },
              "where the robot is, within a metre and 15 degrees")
          ->type_name("X,Y,YAW_DEG");
  CLI::Option* const zone =
      query.add_option("--zone", arguments.place.zone, "look in this zone only")->type_name("ZONE");
  CLI::Option* const lost = query.add_flag(
      "--lost", arguments.place.lost, "look in the whole map (the default), 0.3 ms a signature");
  near->excludes(zone)->excludes(lost);
  zone->excludes(lost);
  query.add_option("--draw", arguments.draw, "draw the matches and the place: .png, .svg or .html")
      ->type_name("FILE");
  query
      .add_option("--json", arguments.json,
                  "write the result as JSON ('-': standard output, and text to standard error)")
      ->type_name("FILE");
  add_examples(
      query,
      {"zoneloc query --map map --image frame.jpg --calibration camera.yaml --near 0.9,11,-149",
       "zoneloc query --map map --image frame.jpg --calibration camera.yaml --lost \\\n"
       "  --draw why.png --json -"});
  query.callback([&] { command = [&arguments] { return run_query(arguments); }; });
}

}  // namespace zonepack::localize
