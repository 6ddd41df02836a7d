// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/service.hpp"

#include <chrono>

#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kDumpEnd_ns = 2'000'000'000;

}  // namespace

Outcome<void> Service::open(const ServeSettings& settings, const Seqlock<LiveStatus>& status,
                            LiveMemory& memory, std::shared_ptr<const MapVersion> first,
                            std::function<Result<std::uint64_t>(BoundedWriter& to)> dump,
                            const BuildInfo& build) {
  SharedMap& map = memory.map();
  const ServerPorts ports{
      .status = status,
      .events = events,
      .commands = commands,
      .replies = replies,
      .poses = poses,
      .memory_fd = memory.reader_fd(),
      .presence_fd = memory.presence_fd(),
      .map_epoch = map.epoch(),
      .lease_ns = first->model().limits.lease_ns,
      .resident_generation = [&map](ZoneId zone) { return map.generation(zone); },
      .dump = std::move(dump),
      .release = build.release,
      .commit = build.commit,
      .lines = lines};
  served_ = std::move(first);
  const MapModel& model = served_->model();
  auto server = Server::open(settings, ports, served_->catalog(), model.graph, model.pinned);
  if (!server) return server.error();
  server_ = std::move(*server);
  return {};
}

Result<void> Service::start(const Notifier& notifier, std::function<std::uint64_t()> cycles) {
  if (!server_) return {};
  cycles_ = std::move(cycles);
  auto thread =
      Thread::start({.name = "zoned-service"}, true, [this, &notifier] { run(notifier); });
  if (!thread) return thread.error();
  thread_ = std::move(thread).value();
  return {};
}

void Service::stop() noexcept {
  stop_.store(true);
  thread_.join();
  if (server_) (void)server_->stop_dump(monotonic_ns() + kDumpEnd_ns);
}

void Service::run(const Notifier& notifier) {
  while (!stop_.load()) {
    server_->turn(Server::kTurn_ms);
    change_maps();
    watch(notifier);
  }
}

bool Service::ready_for(const std::shared_ptr<const MapVersion>& next) {
  if (!server_) return true;
  const std::lock_guard lock(mutex_);
  if (known_ == next->number()) return true;
  coming_ = next;
  return false;
}

bool Service::done_with(std::uint32_t map) {
  if (!server_) return true;
  const std::lock_guard lock(mutex_);
  if (gone_ == map) return true;
  going_ = map;
  return false;
}

// Behind a turn, which took the events: those of a map that the run is done with as well.
void Service::change_maps() {
  std::shared_ptr<const MapVersion> coming;
  std::uint32_t going = 0;
  {
    const std::lock_guard lock(mutex_);
    coming.swap(coming_);
    going = std::exchange(asked_to_go_, std::exchange(going_, 0));
  }
  if (coming) {
    const MapModel& map = coming->model();
    server_->offer_map(coming->number(), coming->catalog(), map.graph, map.pinned);
    offered_ = std::move(coming);
  }
  if (going != 0) {
    server_->forget_map(going);
    if (served_->number() == going) served_ = std::move(offered_);
    if (offered_ && offered_->number() == going) offered_.reset();
  }
  const std::lock_guard lock(mutex_);
  if (offered_) known_ = offered_->number();
  if (going != 0) gone_ = going;
}

void Service::watch(const Notifier& notifier) {
  const auto period = std::chrono::nanoseconds(notifier.watchdog()).count();
  const std::int64_t now_ns = monotonic_ns();
  if (period == 0 || now_ns - told_ns_ < period / 4) return;
  const std::uint64_t cycles = cycles_();
  if (cycles == cycles_seen_) return;  // the control thread stands: let the watchdog bite
  cycles_seen_ = cycles;
  told_ns_ = now_ns;
  (void)notifier.alive();
}

}  // namespace zonepack
