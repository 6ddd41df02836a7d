// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/zoneloc/add_run.hpp"

#include "platform/command_line/command_line.hpp"

namespace zonepack::localize {

void add_run(CLI::App& app, CameraRunArguments& arguments, std::function<int()>& command) {
  CLI::App& run = *app.add_subcommand(
      "run",
      "finds the robot's pose in a camera's images and gives it to a running zoned, until SIGTERM");
  run.add_option("--calibration", arguments.calibration,
                 "of the camera, and where it sits on the robot (YAML)")
      ->type_name("FILE")
      ->required();
  run.add_option_function<std::string>(
         "--camera",
         [&arguments](const std::string& text) {
           const auto choice = parse_camera(text);
           if (!choice) throw CLI::ValidationError("--camera", choice.error().message);
           arguments.camera = *choice;
           arguments.camera_text = text;
         },
         "v4l2:DEV: a camera; socket:PATH: images of another program (CAMERA.md); "
         "folder:DIR[@SPEED]: those of DIR/rgb.txt, when the clock of a zoned that plays the log "
         "of "
         "the same drive reaches their stamps")
      ->type_name("SOURCE")
      ->required();
  run.add_option("--socket", arguments.socket, "of zoned; else $ZONED_SOCKET, else the usual place")
      ->type_name("PATH");
  run.add_option("--json", arguments.json, "write the summary as JSON ('-': standard output)")
      ->type_name("FILE");
  run.add_option("--seconds", arguments.seconds, "end after this time")
      ->check(CLI::Range(0.01, 1e9))
      ->type_name("N");
  add_examples(run, {"zoneloc run --calibration camera.yaml --camera v4l2:/dev/video0",
                     "zoneloc run --calibration camera.yaml --camera folder:drive@4 --json -",
                     "zoneloc run --calibration camera.yaml --camera socket:/run/camera.sock"});
  run.callback([&] { command = [&arguments] { return run_localizer(arguments); }; });
}

}  // namespace zonepack::localize
