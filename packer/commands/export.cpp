// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/export.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "packer/commands/options.hpp"
#include "packer/console/output_path.hpp"
#include "packer/export/nvblox_export.hpp"
#include "packer/export/zone_export.hpp"
#include "platform/base/failure.hpp"
#include "platform/command_line/command_line.hpp"
#include "platform/files/atomic_file.hpp"

namespace zonepack::packer {
namespace {

constexpr char kLineFormat[] =
    "Each line is one signature, ordered by zone, then id:\n"
    "  zone, id, map_id, weight, stamp, label\n"
    "  pose (optimised, in the map), odometry_pose, ground_truth_pose: 12 numbers, rows of 3x4\n"
    "  keypoints [[x, y, size, angle, response, octave]...], points [[x, y, z] or null...],\n"
    "  word_ids, descriptor_type \"u8\" or \"f32\", descriptor_dim, descriptors\n"
    "  scan {format, range_min, range_max, angle_min, angle_max, angle_increment, max_points,\n"
    "  local_transform, data}, grid {cell_size, view_point, ground, obstacle, empty}\n"
    "  image, depth, depth_confidence, calibration, user_data,\n"
    "  global_descriptors [{type, info, data}...],\n"
    "  links [{to, type, transform, information, user_data}...], velocity, gps, env_sensors\n"
    "Bytes are base64: matrices unzipped, with [rows, columns, OpenCV type] under KEY_shape; "
    "images,\n"
    "depth, calibration and sensors as stored. A payload that was not packed, or that the "
    "signature\n"
    "has not, is null; keypoints, points, word_ids and global_descriptors of a signature without "
    "any\n"
    "are []. A coordinate that the database does not hold is null. Numbers read back exactly, "
    "float32\n"
    "as the double of the same value; NaN and infinities are \"nan\", \"inf\", \"-inf\".\n"
    "Maps of other kinds are written in their own terms (packer/README.md): a line is a keyframe, "
    "a\n"
    "tile of a cloud, or a block of voxels.";

struct ExportArguments {
  std::string folder;
  std::vector<std::string> zones;
  std::string out;
  bool jsonl = false;
};

std::vector<ZoneId> chosen_zones(const MapReader& map, const std::vector<std::string>& names) {
  std::set<ZoneId> chosen;
  for (const std::string& name : names) {
    for (const ZoneId zone : map.zones_named(name)) chosen.insert(zone);
  }
  for (ZoneId zone = 0; names.empty() && zone < map.manifest().zones()->size(); ++zone) {
    chosen.insert(zone);
  }
  return {chosen.begin(), chosen.end()};
}

void write_to_standard_output(std::string_view piece) {
  while (!piece.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, piece.data(), piece.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      throw std::runtime_error(std::string("cannot write to standard output: ") +
                               std::strerror(errno));
    }
    piece.remove_prefix(static_cast<std::size_t>(written));
  }
}

bool is_nvblox(const std::string& out) { return out.ends_with(".nvblx"); }

void run_export(const ExportArguments& arguments) {
  require_writable(arguments.out);
  const MapReader map(arguments.folder);
  const std::vector<ZoneId> zones = chosen_zones(map, arguments.zones);
  if (is_nvblox(arguments.out) && !arguments.jsonl) {
    export_nvblox(map, zones, arguments.out);
    return;
  }
  const auto require = [&](const Result<void>& written) {
    if (written) return;
    throw std::runtime_error(cannot_write(arguments.out, written.error()).message +
                             "; check that its folder exists, is writable and has room");
  };
  std::optional<AtomicFile> file;
  if (!arguments.out.empty()) {
    Result<AtomicFile> created = AtomicFile::create(arguments.out);
    if (!created) require(created.error());
    file.emplace(std::move(*created));
  }
  JsonLines json([&](std::string_view piece) {
    file ? require(file->write(piece)) : write_to_standard_output(piece);
  });
  for (const ZoneId zone : zones) export_zone(map, *map.manifest().zones()->Get(zone), json);
  json.flush();
  if (file) require(file->commit());
}

}  // namespace

void add_export_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<ExportArguments>();
  CLI::App* const command = app.add_subcommand(
      "export", "Write every signature of a map as JSON, for comparison with the database");
  command->footer(kLineFormat);
  command->add_option("DIR", arguments->folder, "folder of the map")->required();
  command->add_option("--zone", arguments->zones, "only this zone, or all parts of it; repeatable")
      ->type_name("Z")
      ->take_all()
      ->allow_extra_args(false);
  command->add_flag("--jsonl", arguments->jsonl,
                    "one JSON object a line: the default, but for an --out that ends in .nvblx");
  command
      ->add_option("--out", arguments->out,
                   "file to write; default standard output. Of an nvblox map, FILE.nvblx is a map "
                   "that nvblox loads")
      ->type_name("FILE");
  add_examples(*command, {"zonepack export map --out map.jsonl",
                          "zonepack export map --zone L1 --zone H1 | head -n 1"});
  command->callback([arguments, &exit_code] {
    run_export(*arguments);
    exit_code = 0;
  });
}

}  // namespace zonepack::packer
