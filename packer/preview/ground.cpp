// SPDX-License-Identifier: Apache-2.0
#include "packer/preview/ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
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
std::size_t merged(std::size_t width, std::size_t height, std::size_t most_cells) {
  std::size_t side = 1;
  const auto pixels = [&] { return ((width + side - 1) / side) * ((height + side - 1) / side); };
  while (pixels() > most_cells) ++side;
  return side;
}

// Pixels of `side` cells on each side, the top row first.
struct Pixels {
  Pixels(std::size_t width, std::size_t height, std::size_t most_cells)
      : side(merged(width, height, most_cells)),
        columns((width + side - 1) / side),
        rows((height + side - 1) / side),
        values(columns * rows, kUnknownPixel) {}

  // The cell at column x and row y, counted from the lower left, is seen in it.
  void see(std::size_t x, std::size_t y, Cell cell) {
    std::uint8_t& pixel = values[(rows - 1 - y / side) * columns + x / side];
    pixel = std::max(pixel, pixel_of(cell));
  }

  report::PlanRaster raster(Point2 corner, double cell_m) const {
    const std::array<PngColor, 4> palette{png_color(report::kUnseen, report::kUnseenOpacity),
                                          PngColor{255, 255, 255, 0},
                                          png_color(report::kOccupied, 0.9), PngColor{}};
    const double pixel_m = cell_m * static_cast<double>(side);
    return {to_png(values, columns, palette),
            {corner,
             {corner.x_m + pixel_m * static_cast<double>(columns),
              corner.y_m + pixel_m * static_cast<double>(rows)}}};
  }

  std::size_t side, columns, rows;
  std::vector<std::uint8_t> values;
};

// A grid whose rows are turned around its lower left corner.
class TurnedGrid {
 public:
  TurnedGrid(const MapImage& image, double yaw_rad)
      : image_(image), cos_(std::cos(yaw_rad)), sin_(std::sin(yaw_rad)) {
    const double wide = static_cast<double>(image.width) * image.resolution_m;
    const double high = static_cast<double>(image.height) * image.resolution_m;
    const Point2 corner{image.x_min_m, image.y_min_m};
    box_ = {corner, corner};
    for (const auto& [u, v] : {std::pair{wide, 0.0}, {0.0, high}, {wide, high}}) {
      const Point2 p{corner.x_m + cos_ * u - sin_ * v, corner.y_m + sin_ * u + cos_ * v};
      box_ = {{std::min(box_.min.x_m, p.x_m), std::min(box_.min.y_m, p.y_m)},
              {std::max(box_.max.x_m, p.x_m), std::max(box_.max.y_m, p.y_m)}};
    }
  }

  const Box2& box() const { return box_; }

  Cell at(Point2 p) const {
    const double dx = p.x_m - image_.x_min_m, dy = p.y_m - image_.y_min_m;
    const double u = (cos_ * dx + sin_ * dy) / image_.resolution_m;
    const double v = (cos_ * dy - sin_ * dx) / image_.resolution_m;
    if (!(u >= 0 && v >= 0 && u < static_cast<double>(image_.width) &&
          v < static_cast<double>(image_.height))) {
      return Cell::kUnknown;
    }
    return image_.at(static_cast<std::size_t>(u), static_cast<std::size_t>(v));
  }

 private:
  const MapImage& image_;
  double cos_, sin_;
  Box2 box_;
};

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
  Pixels pixels(image.width, image.height, most_cells);
  for (std::size_t y = 0; y < image.height; ++y) {
    for (std::size_t x = 0; x < image.width; ++x) {
      pixels.see(x, y, image.cells[y * image.width + x]);
    }
  }
  return pixels.raster({image.x_min_m, image.y_min_m}, image.resolution_m);
}

std::optional<report::PlanRaster> raster_of(const MapDrawing& drawing, std::size_t most_cells) {
  const MapImage& image = drawing.image;
  if (drawing.yaw_rad == 0 || image.cells.empty()) return raster_of(image, most_cells);
  const TurnedGrid grid(image, drawing.yaw_rad);
  const Point2 corner = grid.box().min;
  const double cell_m = image.resolution_m;
  const auto cells = [&](double metres) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(metres / cell_m - 1e-6)));
  };
  const std::size_t width = cells(grid.box().max.x_m - corner.x_m);
  const std::size_t height = cells(grid.box().max.y_m - corner.y_m);
  Pixels pixels(width, height, most_cells);
  for (std::size_t i = 0; i < 4 * width * height; ++i) {  // two points along each side of a cell
    const std::size_t x = i % (2 * width), y = i / (2 * width);
    const Point2 p{corner.x_m + (static_cast<double>(x) + 0.5) * cell_m / 2,
                   corner.y_m + (static_cast<double>(y) + 0.5) * cell_m / 2};
    pixels.see(x / 2, y / 2, grid.at(p));
  }
  return pixels.raster(corner, cell_m);
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
