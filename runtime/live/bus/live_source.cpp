// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/bus/live_source.hpp"

#include <algorithm>
#include <utility>

#include "platform/can/socketcan.hpp"
#include "platform/process/clock.hpp"
#include "runtime/live/bus/log_feed.hpp"
#include "runtime/live/bus/script_source.hpp"
#include "runtime/live/cycle/robot_clock.hpp"
#include "runtime/run/inputs/run_inputs.hpp"

namespace zonepack {
namespace {

Failure not_played(const std::string& name, const Error& error) {
  return failure(name + ": cannot be played: " + to_string(error.code), error.code);
}

class LogSource final : public LiveSource {
 public:
  explicit LogSource(LiveSourceTerms& terms)
      : log_(terms.choice.name, terms.settings.can.interface),
        feed_(log_, std::move(terms.corrections), terms.period_ns, terms.notes) {}

  Outcome<void> start(const std::string& name) {
    if (const auto opened = log_.open(); !opened) {
      return failure(log_.explain(opened.error()), opened.error().code);
    }
    if (const auto started = feed_.start(); !started) return not_played(name, started.error());
    return {};
  }

  RunClock& clock() noexcept override { return feed_; }
  CanBus& bus() noexcept override { return feed_.bus(); }
  SpscQueue<PoseCorrection>& corrections() noexcept override { return feed_.corrections(); }
  std::int64_t start_ns() const noexcept override { return feed_.start_ns(); }
  bool robot() const noexcept override { return false; }
  std::string interface() const override {
    const std::string& name = log_.summary().interface;
    return name.empty() ? "can0" : name;
  }
  void stop() noexcept override { feed_.stop(); }
  void ask_stop() noexcept override { feed_.ask_stop(); }
  const CanLogSummary* log_summary() const noexcept override { return &log_.summary(); }

 private:
  CanLogReader log_;
  LogFeed feed_;
};

class BusSource final : public LiveSource {
 public:
  BusSource(std::unique_ptr<SocketCanBus> bus, const SocketCanSettings& settings)
      : bus_(std::move(bus)), settings_(settings) {}

  RunClock& clock() noexcept override { return clock_; }
  CanBus& bus() noexcept override { return *bus_; }
  SpscQueue<PoseCorrection>& corrections() noexcept override { return corrections_; }
  std::int64_t start_ns() const noexcept override { return start_ns_; }
  bool robot() const noexcept override { return true; }
  std::string interface() const override { return settings_.interface; }
  std::string warning() const override {
    const std::uint32_t granted = bus_->granted_buffer_bytes();
    if (granted == 0 || granted / 2 >= settings_.receive_buffer_bytes) return {};
    return settings_.interface + ": frames may wait in " + std::to_string(granted / 2) +
           " bytes, less than a second of a full bus takes; sysctl net.core.rmem_max=" +
           std::to_string(settings_.receive_buffer_bytes) + ", or give zoned CAP_NET_ADMIN";
  }

 private:
  std::unique_ptr<SocketCanBus> bus_;
  SocketCanSettings settings_;
  RobotClock clock_;
  SpscQueue<PoseCorrection> corrections_{1};  // stays empty
  std::int64_t start_ns_ = monotonic_ns();
};

class ScriptSource final : public LiveSource {
 public:
  ScriptSource(LiveSourceTerms& terms, std::unique_ptr<ScriptedBus> script)
      : script_(std::move(script)),
        interface_(terms.settings.can.interface.empty() ? "can0" : terms.settings.can.interface),
        feed_(script_->wire(), std::move(terms.corrections), terms.period_ns, terms.notes) {
    script_->prepare(feed_.bus());
  }

  Result<void> start() { return feed_.start(); }
  RunClock& clock() noexcept override { return feed_; }
  CanBus& bus() noexcept override { return feed_.bus(); }
  SpscQueue<PoseCorrection>& corrections() noexcept override { return feed_.corrections(); }
  std::int64_t start_ns() const noexcept override { return feed_.start_ns(); }
  bool robot() const noexcept override { return false; }
  std::string interface() const override { return interface_; }
  void stop() noexcept override { feed_.stop(); }
  void ask_stop() noexcept override { feed_.ask_stop(); }

 private:
  std::unique_ptr<ScriptedBus> script_;
  std::string interface_;
  LogFeed feed_;
};

using OpenedSource = Outcome<std::unique_ptr<LiveSource>>;

OpenedSource open_script(LiveSourceTerms& terms) {
  const LoadedCanScript loaded = load_can_script(terms.choice.name);
  std::string faults;
  for (const std::string& fault : loaded.faults) faults += (faults.empty() ? "" : "\n") + fault;
  if (!faults.empty()) return failure(std::move(faults));
  auto script = ScriptedBus::make(loaded.script, terms.settings.can.interface,
                                  cycle_config(terms.settings).odometry);
  if (!script) return script.error();
  auto source = std::make_unique<ScriptSource>(terms, std::move(*script));
  if (const auto started = source->start(); !started) {
    return not_played(terms.choice.name, started.error());
  }
  return OpenedSource(std::move(source));
}

OpenedSource open_bus(const LiveSourceTerms& terms) {
  SocketCanSettings settings;
  settings.interface = terms.choice.name;
  settings.ids = odometry_ids(cycle_config(terms.settings).odometry);
  settings.wait_for_interface = terms.allow_degraded;
  auto bus = SocketCanBus::open(settings);
  if (!bus) {
    return failure(explain_socketcan(settings.interface, bus.error()), bus.error().code);
  }
  return OpenedSource(std::make_unique<BusSource>(std::move(bus).value(), settings));
}

OpenedSource open_log(LiveSourceTerms& terms) {
  const std::string name = terms.choice.name;
  auto log = std::make_unique<LogSource>(terms);
  if (const auto started = log->start(name); !started) return started.error();
  return OpenedSource(std::move(log));
}

}  // namespace

std::vector<CanId> odometry_ids(const WheelOdometrySettings& odometry) {
  std::vector<CanId> ids;
  const auto add = [&ids](const CanId& id) {
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
  };
  for (const CanSignal& signal : signals_of(odometry)) add({signal.id, signal.extended});
  const CanOpenWatchSettings& canopen = odometry.canopen;
  for (std::size_t i = 0; i < canopen.node_count; ++i) add({0x700u + canopen.nodes[i], false});
  if (canopen.sync_timeout_s > 0) add({canopen.sync_id, false});
  return ids;
}

Outcome<std::unique_ptr<LiveSource>> LiveSource::open(LiveSourceTerms terms) {
  switch (terms.choice.kind) {
    case CanSourceChoice::Kind::kSocketCan:
      return open_bus(terms);
    case CanSourceChoice::Kind::kScript:
      return open_script(terms);
    case CanSourceChoice::Kind::kLog:
      break;
  }
  return open_log(terms);
}

}  // namespace zonepack
