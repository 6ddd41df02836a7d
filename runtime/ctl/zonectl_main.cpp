// SPDX-License-Identifier: Apache-2.0
// zonectl: asks and tells a running zoned. Wiring only; the commands live in runtime/ctl.
#include <CLI/CLI.hpp>
#include <cmath>
#include <functional>
#include <iostream>

#include "platform/signals.hpp"
#include "platform/version/version.hpp"
#include "runtime/ctl/commands/commands.hpp"
#include "runtime/protocol/messages.hpp"

namespace {

using namespace zonepack;

// What the command line asked for; run once the socket is known.
struct Command {
  std::function<Outcome<void>(const std::string& socket)> run;
};

template <typename Run>
CLI::App& add(CLI::App& app, Command& command, const char* name, const char* help, Run run) {
  CLI::App& sub = *app.add_subcommand(name, help);
  sub.callback([&command, run] { command.run = run; });
  return sub;
}

struct Words {
  std::string json, zone, from, to, file;
  bool hint = false;
  PoseArguments pose;
};

void add_commands(CLI::App& app, Command& command, Words& words) {
  using std::string;
  add(app, command, "status", "how the run stands",
      [&](const string& s) { return ctl_status(s, words.json); })
      .add_option("--json", words.json, "write it as JSON ('-': standard output)")
      ->type_name("FILE");
  add(app, command, "watch", "a view to leave open; lines where there is no terminal", ctl_watch);
  add(app, command, "events", "events as they happen, until interrupted", ctl_events);
  add(app, command, "zones", "every zone with its state", ctl_zones);
  add(app, command, "metrics", "the status as Prometheus text", ctl_metrics);
  add(app, command, "freeze", "nothing is evicted from here on",
      [](const string& s) { return ctl_freeze(s, true); });
  add(app, command, "unfreeze", "zones are evicted again",
      [](const string& s) { return ctl_freeze(s, false); });
  add(app, command, "pin", "a zone is loaded, and stays until unpinned",
      [&](const string& s) { return ctl_pin(s, words.zone, true); })
      .add_option("ZONE", words.zone)
      ->required();
  add(app, command, "unpin", "a zone may be evicted again",
      [&](const string& s) { return ctl_pin(s, words.zone, false); })
      .add_option("ZONE", words.zone)
      ->required();

  CLI::App& pose = add(app, command, "pose", "tells where the robot stands now, as a fix",
                       [&](const string& s) { return ctl_pose(s, words.pose); });
  const auto finite = CLI::Validator(
      [](string& text) {
        return std::isfinite(std::strtod(text.c_str(), nullptr)) ? string() : "not a number";
      },
      "");
  pose.add_option("X", words.pose.x_m, "metres in the map")->required()->check(finite);
  pose.add_option("Y", words.pose.y_m, "metres in the map")->required()->check(finite);
  pose.add_option("YAW_DEG", words.pose.yaw_deg, "counter-clockwise from x")
      ->required()
      ->check(CLI::Range(-360.0, 360.0));
  pose.add_option("SIGMA", words.pose.sigma_m, "standard deviation of X and Y, metres")
      ->check(CLI::Range(1e-3, 1e3))
      ->capture_default_str();
  pose.add_option("--sigma-yaw", words.pose.sigma_yaw_deg, "of YAW_DEG, degrees")
      ->check(CLI::Range(1e-2, 360.0))
      ->capture_default_str();

  CLI::App& route =
      add(app, command, "route", "the shortest way, through any zones",
          [&](const string& s) { return ctl_route(s, words.from, words.to, words.hint); });
  route.add_option("FROM", words.from, "a zone; '.': where the robot is")->required();
  route.add_option("TO", words.to, "a zone")->required();
  route.add_flag("--hint", words.hint, "zones on the way are loaded ahead of the robot");

  add(app, command, "dump", "saves the recording of the last minutes",
      [&](const string& s) { return ctl_dump(s, words.file); })
      .add_option("FILE", words.file)
      ->required();
}

}  // namespace

// An exception that comes here is a bug: it stops the process.
// NOLINTNEXTLINE(bugprone-exception-escape)
int main(int argc, char** argv) {
  outlive_file_limits();
  CLI::App app(
      "Asks and tells a running zoned.\n"
      "Exit codes: 0 done, 1 zoned or the world said no, 2 usage.",
      "zonectl");
  app.set_version_flag("--version", version_line("zonectl", {{"protocol", kProtocolVersion, {}}}));
  app.require_subcommand(0, 1);  // so that CLI11 names a word it does not know
  app.callback([&app] {
    if (app.get_subcommands().empty()) throw CLI::RequiredError::Subcommand(1);
  });
  CtlArguments arguments;
  app.add_option("--socket", arguments.socket,
                 "zoned's socket; else $ZONED_SOCKET, --config, /run/zoned/zoned.sock")
      ->type_name("PATH");
  app.add_option("--config", arguments.config, "settings whose serve.socket is meant")
      ->type_name("FILE");
  Command command;
  Words words;
  add_commands(app, command, words);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const auto socket = socket_path(arguments);
  const Outcome<void> done = socket ? command.run(*socket) : socket.error();
  if (done) return 0;
  std::cerr << "zonectl: " << done.error().message << '\n';
  return exit_code(done.error());
}
