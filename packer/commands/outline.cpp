// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/outline.hpp"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "packer/commands/options.hpp"
#include "packer/commands/source_options.hpp"
#include "packer/console/output_path.hpp"
#include "packer/console/words.hpp"
#include "packer/outline/map_drawing.hpp"
#include "packer/outline/paths.hpp"
#include "packer/sources/open_source.hpp"
#include "platform/base/failure.hpp"
#include "platform/command_line/command_line.hpp"
#include "platform/files/atomic_file.hpp"

namespace zonepack::packer {
namespace {

using nlohmann::ordered_json;
using Files = std::vector<std::pair<std::string, std::string>>;  // name, content

[[noreturn]] void refuse(const std::string& path, const Error& error) {
  throw std::runtime_error(cannot_write(path, error).message +
                           "; the files that were there are untouched");
}

void write_together(const std::filesystem::path& folder, const Files& files) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw std::runtime_error(folder.string() + ": cannot create the folder: " + error.message());
  std::vector<AtomicFile> parts;
  for (const auto& [name, content] : files) {
    const std::string path = (folder / name).string();
    if (std::filesystem::is_directory(path)) refuse(path, {ErrorCode::kIo, EISDIR});
    Result<AtomicFile> part = AtomicFile::create(path);
    if (!part) refuse(path, part.error());
    if (const Result<void> written = part->write(content); !written) {
      refuse(path, written.error());
    }
    parts.push_back(std::move(*part));
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (const Result<void> done = parts[i].commit(); !done) {
      refuse((folder / files[i].first).string(), done.error());
    }
  }
}

ordered_json to_json(const MapDrawing& plan) {
  const MapImage& image = plan.image;
  if (image.cells.empty()) return nullptr;
  return {{"source", plan.source},
          {"detail", plan.detail},
          {"grids", plan.grids},
          {"width", image.width},
          {"height", image.height},
          {"resolution_m", image.resolution_m},
          {"origin", {image.x_min_m, image.y_min_m}},
          {"free_cells", image.count(Cell::kFree)},
          {"occupied_cells", image.count(Cell::kOccupied)},
          {"unknown_cells", image.count(Cell::kUnknown)}};
}

void print_next_step(const OutlineOptions& options, bool with_map, std::ostream& text) {
  const std::string folder = options.out.string();
  text
      << "\nNext: draw the zones, for example in QGIS.\n"
         "  1. Open "
      << folder << "/signatures.geojson, trajectories.geojson" << (with_map ? " and map.pgm" : "")
      << ". Coordinates are metres of the map frame;\n"
         "     EPSG:3857 only stands for \"a plane in metres\". Keep it for the project and for "
         "every "
         "layer.\n"
         "  2. New layer of type Polygon with text fields name, zone_type and label; draw a "
         "polygon "
         "for every room\n"
         "     and corridor. Turn on snapping to vertices and segments, so that neighbours share "
         "their "
         "borders.\n"
         "  3. Portals are found where zones share a border. To say where the doors are, add lines "
         "with\n"
         "     \"portal\": true and \"zones\": [\"A\", \"B\"] to the exported file.\n"
         "  4. Export as GeoJSON in EPSG:3857 (not WGS 84: that would turn metres into degrees), "
         "then\n"
         "     zonepack check-zones zones.geojson --db "
      << options.source.name() << "\n";
}

}  // namespace

void write_outline(const OutlineOptions& options, std::ostream& text, ordered_json& json) {
  const std::unique_ptr<MapSource> source = open_source(options.source);
  const MapOutline& outline = source->outline();
  require_signatures(outline, options.source.name());
  const MapDrawing plan = drawing_of(*source, options.source.slice);
  const std::vector<Path> paths = paths_of(outline);
  const std::size_t linked = outline.nodes.size() - outline.unlinked();

  Files files;
  const bool with_map = !plan.image.cells.empty();
  if (with_map) {
    files.emplace_back("map.pgm", to_pgm(plan.image));
    files.emplace_back("map.yaml", map_yaml(plan.image, "map.pgm"));
    files.emplace_back("map.wld", world_file(plan.image));
  }
  files.emplace_back("signatures.geojson", signatures_geojson(outline));
  files.emplace_back("trajectories.geojson", trajectories_geojson(paths));
  source->require_unchanged();
  write_together(options.out, files);

  std::vector<std::string> warnings = outline.warnings;
  warnings.insert(warnings.end(), plan.warnings.begin(), plan.warnings.end());
  if (!with_map) {
    warnings.push_back(options.source.name() + ": " + plan.missing +
                       "; no map.pgm is written, draw along the trajectories");
  }
  if (outline.unlinked() > 0) {
    warnings.push_back(options.source.name() + ": " + std::to_string(outline.unlinked()) + " of " +
                       std::to_string(outline.nodes.size()) +
                       " signatures have no optimised pose and are not drawn");
  }
  text << options.out.string() << ": " << counted(linked, "signature") << ", "
       << counted(paths.size(), "trajectory", "trajectories");
  if (with_map) {
    text << ", a map of " << plan.image.width << " x " << plan.image.height << " cells of "
         << plan.image.resolution_m << " m from " << plan.origin();
  }
  text << "\n";
  for (const std::string& warning : warnings) text << "warning: " << warning << "\n";
  print_next_step(options, with_map, text);

  json["out"] = options.out.string();
  json["files"] = ordered_json::array();
  for (const auto& [name, content] : files) json["files"].push_back(name);
  json["signatures"] = linked;
  json["unlinked"] = outline.unlinked();
  json["trajectories"] = paths.size();
  json["map"] = to_json(plan);
  json["warnings"] = warnings;
}

void add_outline_command(CLI::App& app, int& exit_code) {
  struct Arguments {
    OutlineOptions options;
    JsonOutput json;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = app.add_subcommand(
      "outline", "Write a floor plan, signatures and trajectories for drawing zones (QGIS)");
  add_source_options(*command, arguments->options.source, "the map")->required();
  add_slice_option(*command, arguments->options.source);
  command->add_option("--out", arguments->options.out, "folder for the files")
      ->type_name("DIR")
      ->required();
  arguments->json.add_option(*command);
  command->footer(
      "Writes map.pgm and map.yaml (for ROS map_server: the database's own map, else assembled "
      "from the\n"
      "local grids, else a slice of the points or voxels at a robot's height), map.wld (for "
      "QGIS),\n"
      "signatures.geojson and trajectories.geojson, all in metres of the map frame. Files of an\n"
      "earlier run are replaced only after all have been written.");
  add_examples(*command, {"zonepack outline --db map.db --out outline",
                          "zonepack outline --db cloud.pcd --slice 0.3,1.2 --out outline"});
  command->callback([arguments, &exit_code] {
    require_writable_folder(arguments->options.out, "--out");
    arguments->json.require_writable();
    ordered_json json;
    write_outline(arguments->options, arguments->json.text(), json);
    arguments->json.write(json);
    exit_code = 0;
  });
}

}  // namespace zonepack::packer
