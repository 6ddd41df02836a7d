// SPDX-License-Identifier: Apache-2.0
#include "runtime/listen/frame_feed.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "platform/can/socketcan.hpp"
#include "platform/process/clock.hpp"
#include "platform/sim/sim_can_bus.hpp"
#include "runtime/live/bus/script_source.hpp"
#include "runtime/live/messages/bus_messages.hpp"

namespace zonepack {
namespace {

// A bus that is asked again and again.
class PolledBus {
 public:
  explicit PolledBus(std::string interface) : messages_(std::move(interface)) {}

  std::optional<CanFrame> take(CanBus& bus) noexcept {
    if (taken_ == count_) {
      taken_ = 0;
      count_ = bus.receive(frames_);
      if (count_ == 0) return std::nullopt;
    }
    return frames_[taken_++];
  }
  std::optional<std::string> message(const CanBus& bus) { return messages_.next(bus.status()); }

 private:
  std::array<CanFrame, 64> frames_{};
  std::size_t count_ = 0, taken_ = 0;
  BusMessages messages_;
};

class WholeLog final : public FrameFeed {
 public:
  WholeLog(const std::string& path, const std::string& interface) : log_(path, interface) {}

  Outcome<void> start() {
    if (const auto opened = log_.open(); !opened) {
      return failure(log_.explain(opened.error()), opened.error().code);
    }
    return {};
  }
  std::optional<CanFrame> next() noexcept override {
    const auto frame = log_.next();
    if (frame) latest_ns_ = std::max(latest_ns_, frame->stamp_ns);
    ended_ = !frame;
    return frame;
  }
  std::uint64_t dropped() const noexcept override { return log_.dropped(); }
  bool ended() const noexcept override { return ended_; }
  std::int64_t now_ns() const noexcept override { return latest_ns_; }
  bool paced() const noexcept override { return false; }
  const CanLogSummary* log_summary() const noexcept override { return &log_.summary(); }

 private:
  CanLogReader log_;
  std::int64_t latest_ns_ = INT64_MIN;
  bool ended_ = false;
};

// A log or a script on its own time, or faster or slower.
class PacedFrames final : public FrameFeed {
 public:
  PacedFrames(std::unique_ptr<CanLogReader> log, std::unique_ptr<ScriptedBus> script,
              const std::string& interface, double speed)
      : log_(std::move(log)), script_(std::move(script)), polled_(interface), speed_(speed) {
    if (script_) script_->prepare(bus_);
    start_ns_ = bus_.next_arrival_ns().value_or(0);
    began_ns_ = monotonic_ns();
  }

  std::optional<CanFrame> next() noexcept override {
    bus_.advance_to(now_ns());
    return polled_.take(bus_);
  }
  std::uint64_t dropped() const noexcept override { return bus_.dropped(); }
  bool ended() const noexcept override { return !bus_.next_arrival_ns(); }
  std::int64_t now_ns() const noexcept override {
    return start_ns_ +
           static_cast<std::int64_t>(static_cast<double>(monotonic_ns() - began_ns_) * speed_);
  }
  bool paced() const noexcept override { return true; }
  std::optional<std::string> message() override { return polled_.message(bus_); }
  const CanLogSummary* log_summary() const noexcept override {
    return log_ ? &log_->summary() : nullptr;
  }

 private:
  CanFrameSource* source() noexcept {
    return log_ ? static_cast<CanFrameSource*>(log_.get()) : &script_->wire();
  }

  std::unique_ptr<CanLogReader> log_;
  std::unique_ptr<ScriptedBus> script_;
  mutable SimCanBus bus_{source()};
  PolledBus polled_;
  double speed_;
  std::int64_t start_ns_ = 0, began_ns_ = 0;
};

class KernelBus final : public FrameFeed {
 public:
  KernelBus(std::unique_ptr<SocketCanBus> bus, const std::string& interface)
      : bus_(std::move(bus)), polled_(interface) {}

  std::optional<CanFrame> next() noexcept override { return polled_.take(*bus_); }
  std::uint64_t dropped() const noexcept override { return bus_->dropped(); }
  bool ended() const noexcept override { return false; }
  std::int64_t now_ns() const noexcept override { return monotonic_ns(); }
  bool paced() const noexcept override { return true; }
  std::optional<std::string> message() override { return polled_.message(*bus_); }

 private:
  std::unique_ptr<SocketCanBus> bus_;
  PolledBus polled_;
};

using OpenedFeed = Outcome<std::unique_ptr<FrameFeed>>;

OpenedFeed open_log(const FeedChoice& choice, const std::string& interface) {
  const std::string& path = choice.source.name;
  if (!choice.paced) {
    auto feed = std::make_unique<WholeLog>(path, interface);
    if (const auto started = feed->start(); !started) return started.error();
    return OpenedFeed(std::move(feed));
  }
  auto log = std::make_unique<CanLogReader>(path, interface);
  if (const auto opened = log->open(); !opened) {
    return failure(log->explain(opened.error()), opened.error().code);
  }
  return OpenedFeed(
      std::make_unique<PacedFrames>(std::move(log), nullptr, path, choice.source.speed));
}

OpenedFeed open_script(const FeedChoice& choice, const Settings& settings) {
  const LoadedCanScript loaded = load_can_script(choice.source.name);
  std::string faults;
  for (const std::string& fault : loaded.faults) faults += (faults.empty() ? "" : "\n") + fault;
  if (!faults.empty()) return failure(std::move(faults));
  auto script = ScriptedBus::make(loaded.script, settings.can.interface, settings.odometry.wheels);
  if (!script) return script.error();
  return OpenedFeed(std::make_unique<PacedFrames>(nullptr, std::move(*script), choice.source.name,
                                                  choice.source.speed));
}

OpenedFeed open_bus(const std::string& interface) {
  SocketCanSettings all;
  all.interface = interface;  // no ids: what no setting names is listed too
  auto bus = SocketCanBus::open(all);
  if (!bus) return failure(explain_socketcan(interface, bus.error()), bus.error().code);
  return OpenedFeed(std::make_unique<KernelBus>(std::move(bus).value(), interface));
}

}  // namespace

std::optional<FeedChoice> parse_feed_choice(const std::string& text) {
  constexpr std::string_view kLog = "log:";
  if (auto source = parse_can_source(text)) {
    const bool whole = source->kind == CanSourceChoice::Kind::kLog &&
                       source->name.size() + kLog.size() == text.size();
    return FeedChoice{*source, !whole};
  }
  for (const std::string_view prefix : {"socketcan:", "log:", "sim:"}) {
    if (text.starts_with(prefix)) return std::nullopt;
  }
  if (text.empty()) return std::nullopt;
  return FeedChoice{{CanSourceChoice::Kind::kLog, text, 1}, false};
}

Outcome<std::unique_ptr<FrameFeed>> FrameFeed::open(const FeedChoice& choice,
                                                    const Settings& settings) {
  switch (choice.source.kind) {
    case CanSourceChoice::Kind::kSocketCan:
      return open_bus(choice.source.name);
    case CanSourceChoice::Kind::kScript:
      return open_script(choice, settings);
    case CanSourceChoice::Kind::kLog:
      break;
  }
  return open_log(choice, settings.can.interface);
}

}  // namespace zonepack
