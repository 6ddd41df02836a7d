// SPDX-License-Identifier: Apache-2.0
#include "packer/preview/ground.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "packer/decode/zone_records.hpp"
#include "packer/preview/png_file.hpp"
#include "runtime/report/floor_plan_marks.hpp"

namespace zonepack::packer {
namespace {

constexpr std::uint8_t kUnknownPixel = 0, kFreePixel = 1, kOccupiedPixel = 2;

PngColor png_color(report::Color color, double opacity) {
  return {color.r, color.g, color.b, static_cast<std::uint8_t>(opacity * 255 + 0.5)};
}

std::uint8_t pixel_of(Cell cell) {
  switch (cell) {
    case Cell::kOccupied:
      return kOccupiedPixel;
    case Cell::kFree:
      return kFreePixel;
    case Cell::kUnknown:
      break;
  }
  return kUnknownPixel;
}

// Cells of one pixel's side.
std::size_t merged(const MapImage& image, std::size_t most_cells) {
  std::size_t side = 1;
  const auto pixels = [&] {
    return ((image.width + side - 1) / side) * ((image.height + side - 1) / side);
  };
  while (pixels() > most_cells) ++side;
  return side;
}

PayloadMask packed_in(const MapReader& map, const PayloadSet& wanted) {
  PayloadMask mask = kCoreOnly;
  if (wanted.grid) mask |= mask_of(fb::PayloadKind::Grid);
  if (wanted.scan) mask |= mask_of(fb::PayloadKind::Scan);
  if (wanted.blocks) mask |= mask_of(fb::PayloadKind::Blocks);
  return mask & map.manifest().payload_mask();
}

void see_zone(const MapReader& map, const fb::Zone& zone, PayloadMask wanted,
              const SeeSignature& see) {
  ZoneRecords records(map, zone, wanted);
  for (SignatureRecord record; records.next(record);) see(record);
}

}  // namespace

std::optional<report::PlanRaster> raster_of(const MapImage& image, std::size_t most_cells) {
  if (image.cells.empty()) return std::nullopt;
  const std::size_t side = merged(image, most_cells);
  const std::size_t columns = (image.width + side - 1) / side;
  const std::size_t rows = (image.height + side - 1) / side;
  std::vector<std::uint8_t> pixels(columns * rows, kUnknownPixel);
  for (std::size_t y = 0; y < image.height; ++y) {
    for (std::size_t x = 0; x < image.width; ++x) {
      std::uint8_t& pixel = pixels[(rows - 1 - y / side) * columns + x / side];
      pixel = std::max(pixel, pixel_of(image.cells[y * image.width + x]));
    }
  }
  const std::array<PngColor, 4> palette{png_color(report::kUnseen, report::kUnseenOpacity),
                                        PngColor{255, 255, 255, 0},
                                        png_color(report::kOccupied, 0.9), PngColor{}};
  const double pixel_m = image.resolution_m * static_cast<double>(side);
  const Point2 corner{image.x_min_m, image.y_min_m};
  return report::PlanRaster{to_png(pixels, columns, palette),
                            {corner,
                             {corner.x_m + pixel_m * static_cast<double>(columns),
                              corner.y_m + pixel_m * static_cast<double>(rows)}}};
}

MapDrawing drawing_of(const MapReader& map) {
  std::set<std::string> damages;
  const EachSignature each = [&](const PayloadSet& wanted, const SeeSignature& see) {
    const PayloadMask mask = packed_in(map, wanted);
    if ((mask & ~kCoreOnly) == 0) return;
    for (const fb::Zone* zone : *map.manifest().zones()) {
      try {
        see_zone(map, *zone, mask, see);
      } catch (const std::runtime_error& error) {
        damages.insert(std::string(error.what()) + "; zone '" + zone->name()->str() +
                       "' is left out of the floor plan");
      }
    }
  };
  MapDrawing drawing;
  try {
    drawing = drawing_of(each, {});
  } catch (const std::runtime_error& error) {
    drawing.warnings.push_back(std::string("no grid is drawn: ") + error.what());
  }
  drawing.warnings.insert(drawing.warnings.begin(), damages.begin(), damages.end());
  return drawing;
}

}  // namespace zonepack::packer
