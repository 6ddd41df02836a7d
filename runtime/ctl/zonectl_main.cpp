// SPDX-License-Identifier: Apache-2.0
// zonectl: queries and commands a running zoned. Wiring only; the commands live in runtime/ctl.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <initializer_list>
#include <iostream>
#include <string_view>
#include <utility>

#include "platform/command_line/command_line.hpp"
#include "platform/process/signals.hpp"
#include "platform/version/version.hpp"
#include "runtime/ctl/commands/commands.hpp"
#include "runtime/protocol/messages.hpp"

namespace {

using namespace zonepack;
using Examples = std::initializer_list<std::string_view>;

// What the command line asked for; run once the socket is known.
struct Command {
  std::function<Outcome<void>(const std::string& socket)> run;
};

template <typename Run>
CLI::App& add(CLI::App& app, Command& command, const char* name, const char* help,
              Examples examples, Run run) {
  CLI::App& sub = *app.add_subcommand(name, help);
  sub.callback([&command, run] { command.run = run; });
  add_examples(sub, examples);
  return sub;
}

struct Words {
  std::string json, zone, from, to, file;
  bool hint = false;
  PoseArguments pose;
};

// FILE may be left out: standard output.
CLI::Option* add_json(CLI::App& sub, Words& words, const char* help) {
  return sub
      .add_option_function<std::string>(
          "--json", [&words](const std::string& file) { words.json = file.empty() ? "-" : file; },
          help)
      ->expected(0, 1)
      ->type_name("[FILE]");
}

void add_route(CLI::App& app, Command& command, Words& words) {
  CLI::App& route =
      add(app, command, "route", "the shortest way, through any zones",
          {"zonectl route . R52", "zonectl route L1 R52 --hint", "zonectl route L1 R52 --json"},
          [&](const std::string& s) {
            return ctl_route(s, words.from, words.to, words.hint, words.json);
          });
  CLI::Option* const from = route.add_option("FROM", words.from, "a zone; '.': where the robot is");
  route.add_option("TO", words.to, "a zone");
  route.add_flag("--hint", words.hint, "zones on the way are loaded ahead of the robot");
  CLI::Option* const json =
      add_json(route, words, "write it as JSON (without FILE: standard output)");
  route.callback([&command, &words, &route, from, json] {
    if (words.to.empty() && !words.from.empty() && json->count() > 0 && words.json != "-") {
      // --json took what is a zone: `--json A B`, or `A --json B`.
      const auto& order = route.parse_order();
      const bool json_first = std::ranges::find(order, json) < std::ranges::find(order, from);
      words.to = json_first ? std::exchange(words.from, words.json) : words.json;
      words.json = "-";
    }
    if (words.from.empty()) throw CLI::RequiredError("FROM");
    if (words.to.empty()) throw CLI::RequiredError("TO");
    command.run = [&words](const std::string& s) {
      return ctl_route(s, words.from, words.to, words.hint, words.json);
    };
  });
}

void add_pose(CLI::App& app, Command& command, Words& words) {
  CLI::App& pose = add(app, command, "pose", "says where the robot stands now, as a fix",
                       {"zonectl pose 12.5 -3 90", "zonectl pose 12.5 -3 90 0.2 --sigma-yaw 3"},
                       [&](const std::string& s) { return ctl_pose(s, words.pose); });
  const auto finite = CLI::Validator(
      [](std::string& text) {
        return std::isfinite(std::strtod(text.c_str(), nullptr)) ? std::string() : "not a number";
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
}

void add_commands(CLI::App& app, Command& command, Words& words) {
  using std::string;
  const auto pin = [&](const char* name, const char* help, Examples examples, bool pinned) {
    add(app, command, name, help, examples,
        [&words, pinned](const string& s) { return ctl_pin(s, words.zone, pinned); })
        .add_option("ZONE", words.zone)
        ->required();
  };
  add_json(add(app, command, "status", "how the run stands",
               {"zonectl status", "zonectl status --json", "zonectl status --json status.json"},
               [&](const string& s) { return ctl_status(s, words.json); }),
           words, "write it as JSON ('-', or no FILE: standard output)");
  add(app, command, "watch", "a view to leave open; lines where there is no terminal",
      {"zonectl watch"}, ctl_watch);
  add_json(add(app, command, "events", "events as they happen, until interrupted",
               {"zonectl events", "zonectl events --json"},
               [&](const string& s) { return ctl_events(s, words.json); }),
           words, "write them as JSON, an event a line ('-', or no FILE: standard output)");
  add_json(add(app, command, "zones", "every zone with its state",
               {"zonectl zones", "zonectl zones --json", "zonectl zones --json zones.json"},
               [&](const string& s) { return ctl_zones(s, words.json); }),
           words, "write them as JSON ('-', or no FILE: standard output)");
  add(app, command, "metrics", "the status as Prometheus text", {"zonectl metrics"}, ctl_metrics);
  add(app, command, "freeze", "nothing is evicted from here on", {"zonectl freeze"},
      [](const string& s) { return ctl_freeze(s, true); });
  add(app, command, "unfreeze", "zones are evicted again", {"zonectl unfreeze"},
      [](const string& s) { return ctl_freeze(s, false); });
  pin("pin", "a zone is loaded, and stays until unpinned", {"zonectl pin R52"}, true);
  pin("unpin", "a zone may be evicted again", {"zonectl unpin R52"}, false);
  add_pose(app, command, words);
  add_route(app, command, words);
  add(app, command, "dump", "saves the recording of the last minutes",
      {"zonectl dump last.zpr", "zonectl dump last.zpr --socket /run/zoned/zoned.sock"},
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
      "Queries and commands a running zoned.\n"
      "Exit codes: 0 done, 1 zoned or the world said no, 2 usage.",
      "zonectl");
  app.set_version_flag("--version", version_line("zonectl", {{"protocol", kProtocolVersion, {}}}));
  app.require_subcommand(0, 1);  // so that CLI11 names a word it does not know
  app.callback([&app] {
    if (app.get_subcommands().empty()) throw CLI::RequiredError::Subcommand(1);
  });
  CtlArguments arguments;
  app.add_option("--socket", arguments.socket,
                 "zoned's socket; else $ZONED_SOCKET, --config, the user's own zoned in "
                 "$XDG_RUNTIME_DIR, /run/zoned/zoned.sock")
      ->type_name("PATH");
  app.add_option("--config", arguments.config, "settings whose serve.socket is meant")
      ->type_name("FILE");
  Command command;
  Words words;
  add_commands(app, command, words);
  add_examples(app, {"zonectl watch", "zonectl status --json", "zonectl events --json",
                     "zonectl --socket /run/zoned/zoned.sock metrics"});
  try {
    parse_command_line(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const auto socket = socket_path(arguments);
  const Outcome<void> done = socket ? command.run(*socket) : socket.error();
  if (done) return 0;
  std::cerr << "zonectl: " << done.error().message << '\n';
  return exit_code(done.error());
}
