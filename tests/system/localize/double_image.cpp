// SPDX-License-Identifier: Apache-2.0
// usage: double_image IN OUT.png [SEED]: an image of twice the width and height, straight between
// pixels, with noise of at most 1 that SEED chooses. The sample database holds its images halved;
// doubled, they look enough like those that its features are of to be localized.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>

#include "runtime/localize/camera/image_file.hpp"
#include "runtime/localize/explain/png_text.hpp"

int main(int argc, char** argv) {
  using namespace zonepack::localize;
  if (argc < 3 || argc > 4) {
    return std::fputs("usage: double_image IN OUT.png [SEED]\n", stderr), 2;
  }
  const auto small = read_image(argv[1]);
  if (!small) return std::fprintf(stderr, "%s\n", small.error().message.c_str()), 1;
  std::minstd_rand noise(argc == 4 ? static_cast<unsigned>(std::atoi(argv[3])) : 1U);
  GreyImage large;
  large.width = 2 * small->width;
  large.height = 2 * small->height;
  const auto pixel = [&](int x, int y) {
    x = std::clamp(x, 0, small->width - 1);
    y = std::clamp(y, 0, small->height - 1);
    return double{static_cast<double>(
        small->pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(small->width) +
                      static_cast<std::size_t>(x)])};
  };
  for (int y = 0; y < large.height; ++y) {
    for (int x = 0; x < large.width; ++x) {
      // The middle of pixel x lies at (x + 0.5) / 2 - 0.5 of the small image.
      const double sx = (x + 0.5) / 2 - 0.5, sy = (y + 0.5) / 2 - 0.5;
      const int left = static_cast<int>(std::floor(sx)), top = static_cast<int>(std::floor(sy));
      const double dx = sx - left, dy = sy - top;
      const double value = (pixel(left, top) * (1 - dx) + pixel(left + 1, top) * dx) * (1 - dy) +
                           (pixel(left, top + 1) * (1 - dx) + pixel(left + 1, top + 1) * dx) * dy;
      const double grain = argc == 4 ? static_cast<double>(noise() % 3) - 1 : 0;
      large.pixels.push_back(
          static_cast<std::uint8_t>(std::clamp(std::lround(value + grain), 0L, 255L)));
    }
  }
  std::ofstream out(argv[2], std::ios::binary);
  out << png_text(large);
  return out.flush() ? 0 : 1;
}
