// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/service.hpp"

#include <chrono>

#include "platform/clock.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kStack_bytes = 256 * 1024;

}  // namespace

bool Service::open(const ServeSettings& settings, const Seqlock<LiveStatus>& status,
                   LiveMemory& memory, const Catalog& catalog, const ZoneGraph& graph,
                   std::span<const ZoneId> pinned, std::int64_t lease_ns,
                   std::function<Result<std::uint64_t>(int fd)> dump, std::string& fault) {
  SharedMap& map = memory.map();
  const ServerPorts ports{
      .status = status,
      .events = events,
      .commands = commands,
      .replies = replies,
      .poses = poses,
      .memory_fd = memory.reader_fd(),
      .lock_fd = memory.lock_fd(),
      .lease_ns = lease_ns,
      .resident_generation = [&map](ZoneId zone) { return map.generation(zone); },
      .dump = std::move(dump),
      .lines = lines};
  server_ = Server::open(settings, ports, catalog, graph, pinned, fault);
  return server_ != nullptr;
}

Result<void> Service::start(const Notifier& notifier, std::function<std::uint64_t()> cycles) {
  if (!server_) return {};
  cycles_ = std::move(cycles);
  auto thread = Thread::start({.name = "zoned-service", .stack_bytes = kStack_bytes}, true,
                              [this, &notifier] { run(notifier); });
  if (!thread) return thread.error();
  thread_ = std::move(thread).value();
  return {};
}

void Service::stop() noexcept {
  stop_.store(true);
  thread_.join();
}

void Service::run(const Notifier& notifier) {
  while (!stop_.load()) {
    server_->turn(Server::kTurn_ms);
    watch(notifier);
  }
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
