// SPDX-License-Identifier: Apache-2.0
#include "packer/preview/ground.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "packer/decode/record_decoder.hpp"
#include "packer/outline/occupancy_map.hpp"
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

// Adds the grids of one zone; returns how many.
std::size_t add_grids(const MapReader& map, const fb::Zone& zone,
                      std::optional<OccupancyMap>& grids) {
  const PackReader pack = map.open_pack(zone);
  const Result<DecodedPack> decoded = DecodedPack::decode(pack, mask_of(fb::PayloadKind::Grid));
  if (!decoded) MapReader::fail(map.pack_path(zone), decoded.error());
  std::size_t added = 0;
  for (std::uint32_t i = 0; i < decoded->view().size(); ++i) {
    const SignatureRecord record = decode_record(decoded->view(), i);
    if (!record.pose || !record.grid || !(record.grid->cell_size > 0)) continue;
    if (!grids) grids.emplace(decimal_of(record.grid->cell_size));
    grids->add(*record.grid, *record.pose);
    ++added;
  }
  return added;
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
  MapDrawing drawing;
  drawing.source = "local grids";
  if ((map.manifest().payload_mask() & mask_of(fb::PayloadKind::Grid)) == 0) return drawing;
  std::optional<OccupancyMap> grids;
  for (const fb::Zone* zone : *map.manifest().zones()) {
    try {
      drawing.grids += add_grids(map, *zone, grids);
    } catch (const std::runtime_error& error) {
      drawing.warnings.push_back(std::string(error.what()) + "; the grids of zone '" +
                                 zone->name()->str() + "' are not drawn");
    }
  }
  try {
    if (grids) drawing.image = grids->image();
  } catch (const std::runtime_error& error) {
    drawing.warnings.push_back(std::string("no grid is drawn: ") + error.what());
  }
  return drawing;
}

}  // namespace zonepack::packer
