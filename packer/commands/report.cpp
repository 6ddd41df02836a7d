// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/report.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <vector>

#include "packer/commands/options.hpp"
#include "packer/commands/source_options.hpp"
#include "packer/console/output_path.hpp"
#include "packer/decode/map_reader.hpp"
#include "packer/preview/ground.hpp"
#include "packer/sources/open_source.hpp"
#include "platform/command_line/command_line.hpp"
#include "runtime/pack_format/file/accounting.hpp"
#include "runtime/pack_format/file/checksum.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

namespace zonepack::packer {
namespace {

std::string payload_names(PayloadMask payload) {
  const std::string list = payload_text(payload);
  std::string names;
  for (const char c : list) names += c == ',' ? std::string(", ") : std::string(1, c);
  return names.empty() ? "poses only" : names;
}

report::PackedZone zone_of(const fb::Zone& zone, std::uint32_t slots, PayloadMask payload) {
  report::PackedZone out{.name = zone.name()->str(),
                         .zone_type = flatbuffers::GetString(zone.zone_type()),
                         .label = flatbuffers::GetString(zone.label()),
                         .layer = flatbuffers::GetString(zone.layer()),
                         .polygon = polygon_of(zone),
                         .signatures = zone.signatures(),
                         .features = zone.features(),
                         .charged_bytes = slots * kSlotBytes,
                         .stored_bytes = chunk_bytes(zone, payload).stored,
                         .signature_positions = {}};
  if (zone.nodes() == nullptr) return out;
  for (const fb::Node* node : *zone.nodes())
    out.signature_positions.push_back({node->x(), node->y()});
  return out;
}

std::string pair_text(const fb::Manifest& manifest, const LargestPair& pair) {
  const auto name = [&](ZoneId zone) { return manifest.zones()->Get(zone)->name()->str(); };
  if (pair.zone_a == kNoZone) return "no zone";
  if (pair.zone_b == kNoZone) return name(pair.zone_a);
  return name(pair.zone_a) + " with " + name(pair.zone_b);
}

std::string source_text(const fb::Provenance& source) {
  std::string text = "Packed from " + flatbuffers::GetString(source.source_kind());
  const std::string version = flatbuffers::GetString(source.source_version());
  const std::string packer = flatbuffers::GetString(source.packer_version());
  if (!version.empty()) text += " " + version;
  if (!packer.empty()) text += " by zonepack " + packer;
  return text + ".";
}

struct ReportOptions {
  std::string folder, out;
  PayloadMask payload = kDefaultPayload;
  SourceOptions source;
};

MapDrawing ground_of(const ReportOptions& options) {
  if (options.source.path.empty()) return drawing_of(MapReader(options.folder));
  const std::unique_ptr<MapSource> source = open_source(options.source);
  MapDrawing drawing = drawing_of(*source, options.source.slice);
  drawing.warn_if_missing(options.source.name());
  source->require_unchanged();
  return drawing;
}

void run_report(const ReportOptions& options) {
  require_writable(options.out);
  report::PackReport map = read_pack_report(options.folder, options.payload);
  const MapDrawing ground = ground_of(options);
  for (const std::string& warning : ground.warnings) std::cerr << "warning: " << warning << "\n";
  map.ground = raster_of(ground.image);
  const auto written = report::write_report(options.out, report::make_pack_report(map));
  if (!written) throw std::runtime_error(written.error().message);
}

}  // namespace

report::PackReport read_pack_report(const std::string& folder, PayloadMask payload) {
  const MapReader reader(folder);
  const fb::Manifest& manifest = reader.manifest();
  const MapCosts costs = map_costs(manifest, reader.manifest_file().size(), payload);
  const SmallestBudget smallest = smallest_budget(costs, {});
  report::PackReport map;
  map.map = folder;
  map.version = to_hex(manifest_digest(reader.manifest_file()));
  map.payload = payload_names(payload & manifest.payload_mask());
  map.source = source_text(*manifest.provenance());
  const std::uint64_t slots =
      std::accumulate(costs.zone_slots.begin(), costs.zone_slots.end(), std::uint64_t{0});
  map.table_bytes = charged_with(costs.fixed_bytes, slots) - slots * kSlotBytes;
  map.smallest_budget_bytes = smallest.bytes;
  map.smallest_budget_pair = pair_text(manifest, smallest.pair);
  for (flatbuffers::uoffset_t i = 0; i < manifest.zones()->size(); ++i) {
    map.zones.push_back(zone_of(*manifest.zones()->Get(i), costs.zone_slots[i], payload));
  }
  if (manifest.portals() == nullptr) return map;
  for (const fb::Portal* portal : *manifest.portals()) {
    map.portals.push_back(
        {{portal->p()->x(), portal->p()->y()}, {portal->q()->x(), portal->q()->y()}});
  }
  return map;
}

CLI::Option* add_report_option(CLI::App& app, std::string& out, const std::string& help,
                               const std::string& name) {
  return app.add_option(name, out, help)->type_name("FILE")->check([](const std::string& path) {
    return report::check_report_name(path).error().message;
  });
}

void add_report_command(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* const command = app.add_subcommand(
      "report",
      "Draw a map: the floor plan with its zones coloured by the bytes they charge, over the "
      "occupancy grid");
  command->add_option("DIR", options->folder, "folder of the map")->required();
  add_report_option(*command, options->out, "file to write: .html, .png or .svg")->required();
  add_payload_option(*command, "--payload", options->payload,
                     "what to count besides the core; default features,scan,grid,blocks");
  add_source_options(*command, options->source,
                     "take the occupancy grid from this map instead of the packs");
  add_slice_option(*command, options->source);
  add_examples(*command, {"zonepack report map --out map.html",
                          "zonepack report map --db map.db --out map.svg"});
  command->callback([options, &exit_code] {
    run_report(*options);
    exit_code = 0;
  });
}

}  // namespace zonepack::packer
