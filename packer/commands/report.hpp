// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <string>

#include "runtime/pack_format/chunk_view.hpp"
#include "runtime/report/pack_report.hpp"

namespace zonepack::packer {

// Reads the manifest of a packed map for drawing. Byte counts are those of the kinds of `payload`
// that the map holds. Throws std::runtime_error with a complete message.
report::PackReport read_pack_report(const std::string& folder,
                                    PayloadMask payload = kDefaultPayload);

// The option of commands that draw: takes names that end in .html, .svg or .png.
CLI::Option* add_report_option(CLI::App& app, std::string& out, const std::string& help,
                               const std::string& name = "--out");

// `zonepack report DIR --out FILE.html|.png|.svg [--payload LIST] [--db DB]`; sets exit_code when
// it has run.
void add_report_command(CLI::App& app, int& exit_code);

}  // namespace zonepack::packer
