// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/near_boxes.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace zonepack::packer {
namespace {

// How many of the widest stretches would stand side by side.
class Spread {
 public:
  void add(double low, double high) {
    low_ = std::min(low_, low);
    high_ = std::max(high_, high);
    widest_ = std::max(widest_, high - low);
  }
  double count() const { return widest_ > 0 ? (high_ - low_) / widest_ : 0; }

 private:
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
  double widest_ = 0;
};

}  // namespace

NearBoxes::NearBoxes(std::vector<Box2> boxes) : boxes_(std::move(boxes)) {
  Spread x, y;
  for (const Box2& box : boxes_) {
    x.add(box.min.x_m, box.max.x_m);
    y.add(box.min.y_m, box.max.y_m);
  }
  along_y_ = y.count() > x.count();
  stretches_.reserve(boxes_.size());
  for (const Box2& box : boxes_) stretches_.add(low(box), high(box));
  stretches_.sort();
}

const std::vector<std::uint32_t>& NearBoxes::after(std::uint32_t place, double margin_m,
                                                   std::uint64_t& looked_at) {
  const Box2& own = boxes_[place];
  near_.clear();
  for (const std::uint32_t other :
       stretches_.touching(low(own) - margin_m, high(own) + margin_m, looked_at)) {
    if (other > place && boxes_meet(own, boxes_[other], margin_m)) near_.push_back(other);
  }
  return near_;
}

}  // namespace zonepack::packer
