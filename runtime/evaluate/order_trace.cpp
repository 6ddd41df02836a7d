// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/order_trace.hpp"

#include <array>
#include <string_view>
#include <utility>

namespace zonepack {
namespace {

constexpr std::array<std::string_view, 6> kWords = {"requested", "loaded",  "released",
                                                    "held",      "removed", "evicted"};

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + '"';
}

class TracedOrder final : public EvictionOrder {
 public:
  TracedOrder(std::unique_ptr<EvictionOrder> order, OrderTrace& trace)
      : order_(std::move(order)), trace_(trace) {}

  void begin_cycle(const EvictionMoment& moment) noexcept override {
    now_ns_ = moment.now_ns;
    order_->begin_cycle(moment);
  }
  void requested(ZoneId zone, bool resident) noexcept override {
    add(OrderTrace::Op::kRequested, zone);
    order_->requested(zone, resident);
  }
  void loaded(ZoneId zone, ZoneNeed need) noexcept override {
    trace_.add(now_ns_, OrderTrace::Op::kLoaded, zone, need);
    order_->loaded(zone, need);
  }
  void released(ZoneId zone) noexcept override {
    add(OrderTrace::Op::kReleased, zone);
    order_->released(zone);
  }
  void held(ZoneId zone) noexcept override {
    add(OrderTrace::Op::kHeld, zone);
    order_->held(zone);
  }
  void removed(ZoneId zone) noexcept override {
    add(OrderTrace::Op::kRemoved, zone);
    order_->removed(zone);
  }
  ZoneId choose(const EvictionCandidates& candidates) noexcept override {
    const ZoneId zone = order_->choose(candidates);
    add(OrderTrace::Op::kEvicted, zone);
    return zone;
  }

 private:
  void add(OrderTrace::Op op, ZoneId zone) { trace_.add(now_ns_, op, zone); }

  std::unique_ptr<EvictionOrder> order_;
  OrderTrace& trace_;
  std::int64_t now_ns_ = 0;
};

}  // namespace

std::string OrderTrace::csv(std::span<const std::string> zone_names) const {
  std::string text = "t_ns,op,zone,slots,signatures\n";
  for (const Row& row : rows_) {
    text += std::to_string(row.t_ns) + ',';
    text += kWords[static_cast<std::size_t>(row.op)];
    text += ',' + csv_field(zone_names[row.zone]);
    if (row.op == Op::kLoaded) {
      text += ',' + std::to_string(row.need.slots) + ',' + std::to_string(row.need.signatures);
    } else {
      text += ",,";
    }
    text += '\n';
  }
  return text;
}

std::unique_ptr<EvictionOrder> traced(std::unique_ptr<EvictionOrder> order, OrderTrace& trace) {
  return std::make_unique<TracedOrder>(std::move(order), trace);
}

}  // namespace zonepack
