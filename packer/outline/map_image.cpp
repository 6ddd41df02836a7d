// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/map_image.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <stdexcept>

namespace zonepack::packer {
namespace {

std::string decimal(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.10g", value);
  return buffer;
}

char gray(Cell cell) {
  switch (cell) {
    case Cell::kOccupied:
      return 0;
    case Cell::kFree:
      return static_cast<char>(254);
    case Cell::kUnknown:
      break;
  }
  return static_cast<char>(205);
}

}  // namespace

std::size_t MapImage::count(Cell cell) const {
  return static_cast<std::size_t>(std::count(cells.begin(), cells.end(), cell));
}

double decimal_of(float value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  double decimal = value;
  std::from_chars(buffer, end, decimal);
  return decimal;
}

MapImage image_of(const OptimisedMap& map) {
  MapImage image;
  image.width = static_cast<std::size_t>(map.cells.cols);
  image.height = static_cast<std::size_t>(map.cells.rows);
  image.resolution_m = decimal_of(map.resolution);
  image.x_min_m = decimal_of(map.x_min);
  image.y_min_m = decimal_of(map.y_min);
  if (map.cells.data.size() != image.width * image.height) {
    throw std::runtime_error("the database's own map is not one byte a cell");
  }
  for (const std::byte byte : map.cells.data) {
    const auto value = static_cast<std::int8_t>(byte);
    image.cells.push_back(value < 0 ? Cell::kUnknown : value >= 50 ? Cell::kOccupied : Cell::kFree);
  }
  return image;
}

std::string to_pgm(const MapImage& image) {
  std::string pgm =
      "P5\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n255\n";
  pgm.reserve(pgm.size() + image.cells.size());
  for (std::size_t row = image.height; row-- > 0;) {
    for (std::size_t column = 0; column < image.width; ++column) {
      pgm += gray(image.cells[row * image.width + column]);
    }
  }
  return pgm;
}

std::string map_yaml(const MapImage& image, const std::string& image_name) {
  return "image: " + image_name + "\nresolution: " + decimal(image.resolution_m) + "\norigin: [" +
         decimal(image.x_min_m) + ", " + decimal(image.y_min_m) +
         ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
}

std::string world_file(const MapImage& image) {
  const double half = image.resolution_m / 2;
  const double top = image.y_min_m + static_cast<double>(image.height) * image.resolution_m;
  return decimal(image.resolution_m) + "\n0\n0\n" + decimal(-image.resolution_m) + "\n" +
         decimal(image.x_min_m + half) + "\n" + decimal(top - half) + "\n";
}

}  // namespace zonepack::packer
