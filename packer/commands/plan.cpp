// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/plan.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "packer/commands/options.hpp"
#include "packer/console/text_table.hpp"
#include "packer/console/words.hpp"
#include "packer/decode/map_reader.hpp"
#include "packer/inspect/map_plan.hpp"
#include "platform/base/nearest_word.hpp"
#include "platform/command_line/command_line.hpp"

namespace zonepack::packer {
namespace {

constexpr char kFormulas[] =
    "smallest budget    = fixed + (pinned + largest pair of neighbours) x slot\n"
    "live change of map = smallest budget + fixed + largest zone x slot\n"
    "where slot is a slot with its tables, and fixed are tables, manifest, zone graph and read\n"
    "buffers. While a map changes, both maps' tables exist, and the robot's zone of the new map "
    "is\n"
    "loaded besides the pair of the old one; the new map is assumed to be as large as this one.\n"
    "Exit code 1 when --budget is below the smallest.";

struct PlanArguments {
  std::string folder;
  ByteCount budget = 0;
  PayloadMask payload = kDefaultPayload;
  std::vector<std::string> pins;
  std::vector<std::string> layers;
  JsonOutput json;
};

std::string pair_text(const MapPlan& plan, ZoneId a, ZoneId b) {
  if (a == kNoZone) return "no zone";
  if (b == kNoZone) return plan.zones[a].name + " alone";
  return plan.zones[a].name + " with " + plan.zones[b].name;
}

nlohmann::ordered_json names(const MapPlan& plan, const std::vector<ZoneId>& zones) {
  auto list = nlohmann::ordered_json::array();
  for (const ZoneId zone : zones) list.push_back(plan.zones[zone].name);
  return list;
}

nlohmann::ordered_json to_json(const MapPlan& plan, const PlanArguments& arguments) {
  nlohmann::ordered_json json;
  json["map"] = arguments.folder;
  json["payload"] = payload_text(plan.payload);
  json["smallest_budget_bytes"] = plan.smallest.bytes;
  json["smallest_budget_slots"] = plan.smallest.slots;
  std::vector<ZoneId> pair;
  for (const ZoneId zone : {plan.smallest.pair.zone_a, plan.smallest.pair.zone_b}) {
    if (zone != kNoZone) pair.push_back(zone);
  }
  json["pair"] = names(plan, pair);
  json["live_change_budget_bytes"] = plan.live_change_bytes;
  json["fixed_bytes"] = plan.fixed_bytes;
  json["transitions_bytes"] = plan.transitions_bytes;
  json["slot_bytes"] = kSlotBytes;
  json["table_bytes_per_slot"] = kTableBytesPerSlot;
  json["zones"] = nlohmann::ordered_json::array();
  for (const ZoneCost& zone : plan.zones) {
    json["zones"].push_back({{"name", zone.name},
                             {"layer", zone.layer.empty() ? nlohmann::ordered_json()
                                                          : nlohmann::ordered_json(zone.layer)},
                             {"loaded", zone.loaded},
                             {"signatures", zone.signatures},
                             {"slots", zone.slots},
                             {"charged_bytes", zone.charged_bytes},
                             {"stored_bytes", zone.stored_bytes},
                             {"pinned", zone.pinned}});
  }
  if (!plan.budget) return json;
  const BudgetPlan& b = *plan.budget;
  nlohmann::ordered_json& budget = json["budget"];
  budget["bytes"] = b.bytes;
  budget["suffices"] = b.suffices;
  budget["slots"] = b.slots;
  budget["largest_zones_at_once"] = b.largest_zones_at_once;
  budget["whole_map"] = b.whole_map;
  budget["zones_without_room"] = names(plan, b.zones_without_room);
  budget["pairs_without_room"] = nlohmann::ordered_json::array();
  for (const auto& [a, c] : b.pairs_without_room) {
    budget["pairs_without_room"].push_back(names(plan, {a, c}));
  }
  return json;
}

void print(const BudgetPlan& b, const MapPlan& plan, std::ostream& out) {
  out << "budget " << size_text(b.bytes) << ": " << counted(b.slots, "slot") << "\n";
  if (!b.suffices) {
    out << "  BELOW THE SMALLEST by " << counted(plan.smallest.bytes - b.bytes, "byte")
        << ": the robot would "
        << (b.zones_without_room.empty() ? "enter a zone before it is loaded\n"
                                         : "refuse to start\n");
  }
  for (const ZoneId zone : b.zones_without_room) {
    out << "  zone " << plan.zones[zone].name << " does not fit\n";
  }
  for (const auto& [a, c] : b.pairs_without_room) {
    out << "  zones " << plan.zones[a].name << " and " << plan.zones[c].name
        << " do not fit together\n";
  }
  if (b.whole_map) {
    out << "  holds the whole map: nothing is ever unloaded\n";
  } else {
    out << "  holds any " << counted(b.largest_zones_at_once, "zone") << " at once\n";
  }
}

void print(const MapPlan& plan, std::ostream& out) {
  const bool layers =
      std::ranges::any_of(plan.zones, [](const ZoneCost& zone) { return !zone.layer.empty(); });
  const auto row = [layers](std::vector<std::string> cells) {
    if (!layers) cells.erase(cells.begin() + 1);
    return cells;
  };
  TextTable table(row({"zone", "layer", "signatures", "charged MiB", "stored MiB", ""}));
  std::uint64_t signatures = 0, charged = 0, stored = 0;
  std::vector<std::string> names;
  for (const ZoneCost& zone : plan.zones) names.push_back(zone.name);
  for (const std::size_t i : natural_order(names)) {
    const ZoneCost& zone = plan.zones[i];
    const char* const note = zone.pinned ? "pinned" : zone.loaded ? "" : "not loaded";
    table.add(row({zone.name, zone.layer, std::to_string(zone.signatures),
                   mib_text(zone.charged_bytes), mib_text(zone.stored_bytes), note}));
    signatures += zone.signatures;
    charged += zone.charged_bytes;
    stored += zone.stored_bytes;
  }
  table.add(row({"all", "", std::to_string(signatures), mib_text(charged), mib_text(stored), ""}));
  table.print(out);
  const std::string payload = payload_text(plan.payload);
  out << "\nloaded: core" << (payload.empty() ? "" : "," + payload) << "\nfixed "
      << size_text(plan.fixed_bytes) << "\nsmallest budget " << size_text(plan.smallest.bytes)
      << ", " << counted(plan.smallest.slots, "slot") << ", set by "
      << pair_text(plan, plan.smallest.pair.zone_a, plan.smallest.pair.zone_b)
      << "\n  less where these are cut: build --max-zone-bytes SIZE, suggest-zones --max-length "
         "METRES"
      << "\nto change maps live " << size_text(plan.live_change_bytes)
      << "\nwith preload.transitions or preload.learn " << size_text(plan.transitions_bytes)
      << " more\n";
  if (plan.budget) print(*plan.budget, plan, out);
}

void require_layers(const fb::Manifest& manifest, const std::vector<std::string>& layers,
                    const std::string& folder) {
  std::set<std::string> known;
  for (const fb::Zone* zone : *manifest.zones()) {
    if (zone->layer() != nullptr) known.insert(zone->layer()->str());
  }
  for (const std::string& layer : layers) {
    if (known.contains(layer)) continue;
    throw std::runtime_error(folder + ": no zone of this map is of layer '" + layer + "'" +
                             (known.empty()
                                  ? "; none has a layer"
                                  : known_words_text(layer, {known.begin(), known.end()})));
  }
}

}  // namespace

void add_plan_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<PlanArguments>();
  CLI::App* const command =
      app.add_subcommand("plan", "Show what a map costs in memory, and what a budget allows");
  command->footer(kFormulas);
  command->add_option("DIR", arguments->folder, "folder of the map")->required();
  CLI::Option* const budget =
      add_size_option(*command, "--budget", arguments->budget, "show what this budget allows");
  CLI::Option* const payload =
      add_payload_option(*command, "--payload", arguments->payload,
                         "what to load besides the core; default features,scan,grid,blocks");
  command->add_option("--pin", arguments->pins, "a zone that is always held; repeatable")
      ->type_name("ZONE")
      ->take_all()
      ->allow_extra_args(false);
  command
      ->add_option("--layers", arguments->layers,
                   "zones of other layers are never loaded, as memory.layers has it")
      ->type_name("NAME,NAME")
      ->delimiter(',')
      ->take_all()
      ->allow_extra_args(false);
  arguments->json.add_option(*command);
  add_examples(*command, {"zonepack plan map", "zonepack plan map --budget 8MiB --pin L1",
                          "zonepack plan map --payload features --json -"});
  command->callback([arguments, budget, payload, &exit_code] {
    arguments->json.require_writable();
    const MapReader map(arguments->folder);
    const PayloadMask packed = map.manifest().payload_mask();
    std::ostream& text = arguments->json.text();
    const PayloadMask missing = arguments->payload & ~packed;
    if (payload->count() > 0 && missing != 0) {
      text << "note: this map holds no " << payload_text(missing) << "\n";
    }
    require_layers(map.manifest(), arguments->layers, arguments->folder);
    std::vector<ZoneId> pinned;
    for (const std::string& pin : arguments->pins) {
      for (const ZoneId zone : map.zones_named(pin)) pinned.push_back(zone);
    }
    const MapPlan plan =
        plan_map(map.manifest(), arguments->payload & packed, pinned,
                 budget->count() > 0 ? std::optional(arguments->budget) : std::nullopt,
                 map.manifest_file().size(), arguments->layers);
    print(plan, text);
    arguments->json.write(to_json(plan, *arguments));
    exit_code = plan.budget && !plan.budget->suffices ? 1 : 0;
  });
}

}  // namespace zonepack::packer
