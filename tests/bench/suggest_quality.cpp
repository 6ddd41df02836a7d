// SPDX-License-Identifier: Apache-2.0
// usage: suggest_quality [--seeds N] [--ratio R] [--pictures DIR]
//        suggest_quality --grid map.yaml --truth drawn.geojson --zones suggested.geojson
// How well `zonepack suggest-zones` finds the rooms of made-up floor plans, as a table (--pictures
// writes each plan and what was found as PPM images); or how well the zones of one file match those
// of another, on the free cells of a grid.
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>

#include "packer/outline/map_server.hpp"
#include "packer/suggest/suggest.hpp"
#include "packer/zones/zone_file.hpp"
#include "packer/zones/zone_text.hpp"
#include "tests/bench/floor_plans.hpp"
#include "tests/bench/room_scores.hpp"

namespace zonepack::bench {
namespace {

// A PPM: rooms in colours at the left, zones at the right.
void write_picture(const std::string& path, const DrawnPlan& plan,
                   const std::vector<std::int32_t>& zone_of) {
  std::ofstream out(path, std::ios::binary);
  const std::int32_t columns = plan.space.columns, rows = plan.space.rows;
  out << "P6\n" << 2 * columns << " " << rows << "\n255\n";
  for (std::int32_t y = rows; y-- > 0;) {
    for (const auto* list : {&plan.room_of, &zone_of}) {
      for (std::int32_t x = 0; x < columns; ++x) {
        const auto i = static_cast<std::size_t>(plan.space.at(x, y));
        const std::int32_t id = plan.space.free[i] != 0 ? (*list)[i] : -2;
        const auto hue = static_cast<std::uint32_t>(id + 7) * 2654435761u;
        for (int k = 0; k < 3; ++k) {
          out.put(id == -2   ? '\0'
                  : id == -1 ? '\xff'
                             : static_cast<char>(90 + (hue >> (8 * k) & 0xff) * 150 / 255));
        }
      }
    }
  }
}

// Of each cell that is free, the zone that holds its centre.
std::vector<std::int32_t> zone_of_cells(const packer::GridFile& map, const packer::ZonePlan& plan) {
  const packer::MapImage& image = map.image;
  std::vector<std::int32_t> zone_of(image.cells.size(), -1);
  for (std::size_t z = 0; z < plan.zones.size(); ++z) {
    const Box2 box = bounds(plan.zones[z].polygon.outer);
    for (std::size_t i = 0; i < zone_of.size(); ++i) {
      if (zone_of[i] >= 0 || image.cells[i] != packer::Cell::kFree) continue;
      const auto column = static_cast<double>(i % image.width);
      const auto row = static_cast<double>(i / image.width);
      const Point2 p{image.x_min_m + (column + 0.5) * image.resolution_m,
                     image.y_min_m + (row + 0.5) * image.resolution_m};
      if (p.x_m < box.min.x_m || p.x_m > box.max.x_m || p.y_m < box.min.y_m ||
          p.y_m > box.max.y_m) {
        continue;
      }
      if (side_of(plan.zones[z].polygon, p) != Side::kOutside) {
        zone_of[i] = static_cast<std::int32_t>(z);
      }
    }
  }
  return zone_of;
}

int compare(const std::string& grid, const std::string& truth, const std::string& zones) {
  const packer::GridFile map = packer::read_grid_file(grid);
  const packer::ZonePlan drawn = packer::load_zone_file(truth).plan;
  const packer::ZonePlan suggested = packer::load_zone_file(zones).plan;
  const RoomScores scores = score_rooms(zone_of_cells(map, drawn), zone_of_cells(map, suggested));
  const auto rooms = static_cast<double>(scores.rooms);
  std::printf(
      "%zu rooms, %zu zones: MCC %.3f, IoU %.3f, %zu rooms with an IoU under 0.6, %.2f %% of "
      "their free ground in no zone\n",
      scores.rooms, suggested.zones.size(), scores.mcc / rooms, scores.iou / rooms, scores.poor,
      100.0 * static_cast<double>(scores.outside) / static_cast<double>(scores.cells));
  return 0;
}

int run(int argc, char** argv) {
  int seeds = 6;
  std::string pictures;
  packer::suggest::Options options;
  std::string grid, truth, zones;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--grid") == 0) grid = argv[i + 1];
    if (std::strcmp(argv[i], "--truth") == 0) truth = argv[i + 1];
    if (std::strcmp(argv[i], "--zones") == 0) zones = argv[i + 1];
    if (std::strcmp(argv[i], "--seeds") == 0) seeds = std::stoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--ratio") == 0) options.door_ratio = std::stod(argv[i + 1]);
    if (std::strcmp(argv[i], "--pictures") == 0) pictures = argv[i + 1];
  }
  if (!grid.empty()) return compare(grid, truth, zones);
  std::printf("%-28s %6s %6s %7s %7s %6s %8s %9s %7s\n", "plans", "rooms", "zones", "MCC", "IoU",
              "poor", "outside", "worst IoU", "ms");
  using Layout = PlanRecipe::Layout;
  int faulty = 0;
  RoomScores all[2];
  for (const bool furnished : {false, true}) {
    for (const auto layout : {Layout::kCorridor, Layout::kLoop, Layout::kHouse, Layout::kLobby}) {
      for (const int look : {0, 1, 2}) {
        RoomScores sum;
        double most_ms = 0;
        PlanRecipe recipe{.layout = layout,
                          .scanned = look > 0,
                          .furnished = furnished,
                          .turned_rad = look == 2 ? 0.35 : 0};
        for (int seed = 1; seed <= seeds; ++seed) {
          recipe.seed = static_cast<std::uint64_t>(seed);
          DrawnPlan plan = draw_plan(recipe);
          const std::clock_t start = std::clock();
          const packer::suggest::Suggestion found =
              packer::suggest::suggest(plan.space, {}, options);
          most_ms =
              std::max(most_ms, 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
          const auto checked = packer::parse_zone_file(packer::zones_geojson(found.plan));
          for (const auto& fault : checked.findings.faults) {
            ++faulty;
            std::printf("%s %d: %s\n", name_of(recipe).c_str(), seed, fault.message.c_str());
          }
          RoomScores scores = score_rooms(plan.room_of, found.regions.of_cell);
          scores.zones = found.plan.zones.size();
          sum.add(scores);
          if (!pictures.empty()) {
            std::filesystem::create_directories(pictures);
            write_picture(pictures + "/" + name_of(recipe) + " " + std::to_string(seed) + ".ppm",
                          plan, found.regions.of_cell);
          }
        }
        const auto rooms = static_cast<double>(sum.rooms);
        std::printf("%-28s %6zu %6zu %7.3f %7.3f %6zu %7.3f%% %9.3f %7.0f\n",
                    name_of(recipe).c_str(), sum.rooms, sum.zones, sum.mcc / rooms, sum.iou / rooms,
                    sum.poor,
                    100.0 * static_cast<double>(sum.outside) / static_cast<double>(sum.cells),
                    sum.worst_iou, most_ms);
        all[furnished ? 1 : 0].add(sum);
      }
    }
    const RoomScores& sum = all[furnished ? 1 : 0];
    const auto rooms = static_cast<double>(sum.rooms);
    std::printf("%-28s %6zu %6zu %7.3f %7.3f %6zu %7.3f%%\n",
                furnished ? "all furnished" : "all empty", sum.rooms, sum.zones, sum.mcc / rooms,
                sum.iou / rooms, sum.poor,
                100.0 * static_cast<double>(sum.outside) / static_cast<double>(sum.cells));
  }
  return faulty == 0 ? 0 : 1;
}

}  // namespace
}  // namespace zonepack::bench

int main(int argc, char** argv) { return zonepack::bench::run(argc, argv); }
