// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>

#include "packer/record/source_kind.hpp"

namespace zonepack::packer {

struct OutlineOptions {
  SourceOptions source;
  std::filesystem::path out;
};

// Writes what a person needs for drawing zones: map.pgm, map.yaml and map.wld (when the database
// holds a map or local grids), signatures.geojson and trajectories.geojson. All files are written
// as parts first and renamed together at the end, so a failure leaves the old ones. Throws
// std::runtime_error.
void write_outline(const OutlineOptions& options, std::ostream& text, nlohmann::ordered_json& json);

// `zonepack outline --db DB --out DIR [--json FILE]`.
void add_outline_command(CLI::App& app, int& exit_code);

}  // namespace zonepack::packer
