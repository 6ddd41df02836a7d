// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "packer/zones/edge_rows.hpp"
#include "runtime/pack_format/file/geometry.hpp"

namespace zonepack::packer {

// The zones near each zone, by the boxes around them, along whichever axis tells them apart better:
// floors drawn one above the other and wings side by side are both found in few steps.
class NearBoxes {
 public:
  explicit NearBoxes(std::vector<Box2> boxes);

  const Box2& operator[](std::uint32_t place) const { return boxes_[place]; }

  // The places after `place`, ascending, whose boxes are within the margin of its own; valid until
  // the next call. `looked_at` counts what had to be compared.
  const std::vector<std::uint32_t>& after(std::uint32_t place, double margin_m,
                                          std::uint64_t& looked_at);

 private:
  double low(const Box2& box) const noexcept { return along_y_ ? box.min.y_m : box.min.x_m; }
  double high(const Box2& box) const noexcept { return along_y_ ? box.max.y_m : box.max.x_m; }

  std::vector<Box2> boxes_;
  bool along_y_ = false;
  Stretches stretches_;
  std::vector<std::uint32_t> near_;
};

}  // namespace zonepack::packer
