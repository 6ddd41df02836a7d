// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/bus/script_source.hpp"

#include <algorithm>
#include <utility>

namespace zonepack {
namespace {

constexpr std::int64_t kBetweenTurns_ns = 20'000'000;

// Puts a frame that was read already before the rest of its source.
class Unread final : public CanFrameSource {
 public:
  Unread(std::optional<CanFrame> first, std::unique_ptr<CanFrameSource> rest)
      : first_(first), rest_(std::move(rest)) {}
  std::optional<CanFrame> next() noexcept override {
    return first_ ? std::exchange(first_, std::nullopt) : rest_->next();
  }
  std::uint64_t dropped() const noexcept override { return rest_->dropped(); }

 private:
  std::optional<CanFrame> first_;
  std::unique_ptr<CanFrameSource> rest_;
};

}  // namespace

RepeatedLog::RepeatedLog(std::string path, std::string interface, std::uint32_t loops)
    : path_(std::move(path)), interface_(std::move(interface)), turns_left_(loops) {}

Outcome<void> RepeatedLog::open() {
  log_ = std::make_unique<CanLogReader>(path_, interface_);
  const auto opened = log_->open();
  if (!opened) return failure(log_->explain(opened.error()), opened.error().code);
  return {};
}

std::optional<CanFrame> RepeatedLog::next() noexcept {
  std::optional<CanFrame> frame = log_->next();
  if (!frame && first_ns_ && --turns_left_ > 0) {
    dropped_before_ += log_->dropped();
    shift_ns_ = last_ns_ + kBetweenTurns_ns - *first_ns_;
    if (open()) frame = log_->next();
  }
  if (!frame) return std::nullopt;
  if (!first_ns_) first_ns_ = frame->stamp_ns;
  frame->stamp_ns += shift_ns_;
  last_ns_ = std::max(last_ns_, frame->stamp_ns);
  return frame;
}

std::uint64_t RepeatedLog::dropped() const noexcept { return dropped_before_ + log_->dropped(); }

Outcome<std::unique_ptr<ScriptedBus>> ScriptedBus::make(const CanScript& script,
                                                        const std::string& interface,
                                                        const WheelOdometrySettings& odometry) {
  std::unique_ptr<CanFrameSource> robot;
  if (script.log.empty()) {
    if (const auto possible = GeneratedDrive::check(odometry); !possible) {
      return failure("drive: " + possible.error().message);
    }
    robot = std::make_unique<GeneratedDrive>(script.drive, odometry);
  } else {
    auto log = std::make_unique<RepeatedLog>(script.log, interface, script.loops);
    if (const auto opened = log->open(); !opened) return opened.error();
    robot = std::move(log);
  }
  const std::optional<CanFrame> first = robot->next();
  auto bus = std::make_unique<ScriptedBus>();
  bus->queue_ = script.queue;
  bus->nodes_.push_back(std::make_unique<Unread>(first, std::move(robot)));
  for (const ScriptTraffic& traffic : script.traffic) {
    CanFrame frame;
    frame.id = traffic.id;
    frame.extended = traffic.extended;
    frame.len = static_cast<std::uint8_t>(traffic.length);
    frame.stamp_ns = first ? first->stamp_ns : 0;
    bus->nodes_.push_back(std::make_unique<PeriodicFrames>(
        frame, static_cast<std::int64_t>(traffic.period_s * 1e9 + 0.5)));
  }
  std::vector<CanFrameSource*> nodes;
  for (const auto& node : bus->nodes_) nodes.push_back(node.get());
  bus->wire_ = std::make_unique<SimWire>(script.wire, std::move(nodes));
  return bus;
}

void ScriptedBus::prepare(SimCanBus& bus) const {
  bus.plan(wire_->links());
  bus.limit_queue(queue_);
}

}  // namespace zonepack
