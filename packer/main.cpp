// SPDX-License-Identifier: Apache-2.0
// zonepack: the workstation's tool. Wiring only; each subcommand lives in packer/commands.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "packer/commands/build.hpp"
#include "packer/commands/check_zones.hpp"
#include "packer/commands/diff.hpp"
#include "packer/commands/export.hpp"
#include "packer/commands/inspect.hpp"
#include "packer/commands/log.hpp"
#include "packer/commands/outline.hpp"
#include "packer/commands/plan.hpp"
#include "packer/commands/prune.hpp"
#include "packer/commands/report.hpp"
#include "packer/commands/suggest_zones.hpp"
#include "packer/commands/tune.hpp"
#include "packer/commands/update.hpp"
#include "packer/commands/verify.hpp"
#include "packer/record/source_kind.hpp"
#include "platform/command_line/command_line.hpp"
#include "platform/process/signals.hpp"
#include "platform/version/version.hpp"
#include "runtime/pack_format/file/pack_file.hpp"

// An exception that comes here is a bug: it stops the process.
// NOLINTNEXTLINE(bugprone-exception-escape)
int main(int argc, char** argv) {
  zonepack::outlive_file_limits();
  CLI::App app(
      "Packs SLAM maps into zones that a robot can keep within a byte budget.\n"
      "Exit codes: 0 done, 1 the input or the world is bad, 2 usage.",
      "zonepack");
  app.set_version_flag(
      "--version", zonepack::version_line(
                       "zonepack", {{"pack format", zonepack::kPackMajor, zonepack::kPackMinor}}));
  app.fallthrough();             // --version, after a subcommand as well
  app.require_subcommand(0, 1);  // so that CLI11 names a word it does not know
  app.callback([&app] {
    if (app.get_subcommands().empty()) throw CLI::RequiredError::Subcommand(1);
  });
  int exit_code = 0;
  zonepack::packer::add_build_command(app, exit_code);
  zonepack::packer::add_update_command(app, exit_code);
  zonepack::packer::add_diff_command(app, exit_code);
  zonepack::packer::add_log_command(app, exit_code);
  zonepack::packer::add_check_zones_command(app, exit_code);
  zonepack::packer::add_export_command(app, exit_code);
  zonepack::packer::add_outline_command(app, exit_code);
  zonepack::packer::add_suggest_zones_command(app, exit_code);
  zonepack::packer::add_tune_command(app, exit_code);
  zonepack::packer::add_plan_command(app, exit_code);
  zonepack::packer::add_inspect_command(app, exit_code);
  zonepack::packer::add_verify_command(app, exit_code);
  zonepack::packer::add_prune_command(app, exit_code);
  zonepack::packer::add_report_command(app, exit_code);
  zonepack::add_examples(app, {"zonepack outline --db map.db --out outline",
                               "zonepack check-zones zones.geojson --db map.db --out preview.html",
                               "zonepack build --db map.db --zones zones.geojson --out map",
                               "zonepack plan map --budget 8MiB"});
  try {
    zonepack::parse_command_line(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const zonepack::packer::SourceUsageError& error) {
    std::cerr << "zonepack: " << error.what() << "\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "zonepack: " << error.what() << "\n";
    return 1;
  }
  return exit_code;
}
