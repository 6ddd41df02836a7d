// SPDX-License-Identifier: Apache-2.0
#include "runtime/client/block_view.hpp"

#include <cmath>

namespace zonepack {

double BlocksView::block_size_m() const noexcept {
  for (std::uint32_t i = 0; i < zone_->size(); ++i) {
    const TableView* const layers = zone_->table(i, fb::Part::BlockLayers);
    if (layers == nullptr) continue;
    const ColumnView bytes = layers->records().front().column(fb::Field::Row);
    if (!bytes || bytes.bytes().size() < sizeof(double)) return 0;
    return read_once<double>(bytes.bytes().data());
  }
  return 0;
}

std::optional<BlockView> BlocksView::at(double x_m, double y_m, double z_m) const noexcept {
  const double size = block_size_m();
  if (!(size > 0)) return std::nullopt;
  std::array<std::int32_t, 3> index{};
  const std::array<double, 3> p = {x_m, y_m, z_m};
  for (std::size_t i = 0; i < 3; ++i) {
    const double place = std::floor(p[i] / size);
    if (!(std::fabs(place) < 2147483647.0)) return std::nullopt;
    index[i] = static_cast<std::int32_t>(place);
  }
  return find(index[0], index[1], index[2]);
}

}  // namespace zonepack
