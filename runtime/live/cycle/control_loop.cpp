// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/cycle/control_loop.hpp"

#include <algorithm>

#include "platform/base/require.hpp"
#include "platform/memory/allocation_watch.hpp"
#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

constexpr std::uint64_t kFiguresEvery = 256;              // cycles
constexpr std::uint64_t kOwnCommand = ~std::uint64_t{0};  // nobody waits for its reply

}  // namespace

const char* to_string(CycleStep step) noexcept {
  switch (step) {
    case CycleStep::kReceive:
      return "receive";
    case CycleStep::kCycle:
      return "cycle";
    case CycleStep::kPublish:
      return "publish";
  }
  return "unknown";
}

ControlLoop::ControlLoop(const ControlSettings& settings, const ControlPorts& ports)
    : settings_(settings), ports_(ports), frames_(settings.most_frames) {}

void ControlLoop::run() noexcept {
  const AllocationWatch watch;
  usage_at_start_ = thread_usage();
  status_.realtime = thread_is_realtime();
  std::int64_t deadline_ns = monotonic_ns();
  for (std::uint64_t cycle = 0; !stop_.load(std::memory_order_relaxed); ++cycle) {
    if (!ports_.clock.await_inputs(cycle)) break;
    const bool waits = monotonic_ns() < deadline_ns;
    sleep_until_ns(deadline_ns);
    const std::int64_t began_ns = monotonic_ns();
    if (waits) wakeup_.add(began_ns - deadline_ns);
    deadline_ns = next_deadline(deadline_ns, began_ns);
    step(cycle, began_ns);
    if (!ports_.clock.more()) break;
  }
  allocations_ = watch.allocations();
}

std::int64_t ControlLoop::next_deadline(std::int64_t deadline_ns, std::int64_t began_ns) noexcept {
  const std::int64_t period_ns = settings_.wall_period_ns;
  const std::int64_t late_periods = (began_ns - deadline_ns) / period_ns;
  if (late_periods <= 0) return deadline_ns + period_ns;
  if (!settings_.judge_deadlines) return began_ns;
  ++ports_.overload.missed_deadlines;
  if (!settings_.may_skip) return deadline_ns + period_ns;
  ports_.overload.skipped_periods += static_cast<std::uint64_t>(late_periods);
  return deadline_ns + (late_periods + 1) * period_ns;
}

bool ControlLoop::offer(MapInUse& next) noexcept {
  MapInUse* none = nullptr;
  return unused_.load(std::memory_order_acquire) == nullptr &&
         offered_.compare_exchange_strong(none, &next, std::memory_order_acq_rel);
}

void ControlLoop::step(std::uint64_t cycle, std::int64_t began_ns) noexcept {
  cycles_.store(cycle + 1, std::memory_order_relaxed);
  CycleInput input;
  input.now_ns = ports_.clock.cycle_time_ns(cycle, began_ns);
  const std::int64_t offset_ns = ports_.clock.offset_ns();

  const std::size_t frames = ports_.bus.receive(frames_);
  ports_.overload.deferred_frames += frames == frames_.size();
  ports_.overload.dropped_frames = ports_.bus.dropped();
  input.frames = {frames_.data(), frames};
  input.corrections = {corrections_.data(), take_corrections(input.now_ns)};
  std::size_t loads = 0;
  while (loads < loads_.size()) {
    const auto load = ports_.loader.poll();
    if (!load) break;
    loads_[loads++] = *load;
  }
  input.loads = {loads_.data(), loads};
  input.commands = {commands_.data(), take_commands()};
  input.edges = {edges_.data(), take_edges(input.now_ns, began_ns)};
  MapInUse* const next = offered_.exchange(nullptr, std::memory_order_acq_rel);
  if (next != nullptr) {
    input.offer.map = next->number;
    input.offer.keeps = true;
  } else {
    input.offer.fault = refused_.exchange(ErrorCode::kOk, std::memory_order_relaxed);
  }
  if (ports_.tap != nullptr) {
    ports_.tap->on_inputs(cycle, input, offset_ns);
    ports_.overload.lost_recordings = ports_.tap->lost();
  }

  const std::int64_t received_ns = monotonic_ns();
  if (next != nullptr) {
    const bool taken = ports_.maps.offer(*next);
    ZP_REQUIRE(taken);
  }
  ports_.maps.run(input);
  if (MapInUse* const unused = ports_.maps.take_unused()) {
    unused_.store(unused, std::memory_order_release);
  }
  const std::int64_t ran_ns = monotonic_ns();
  answer();
  status_.can_frames += frames;
  status_.bus = ports_.bus.status();
  publish(input, began_ns, offset_ns);
  measure(input, cycle, {began_ns, received_ns, ran_ns, monotonic_ns()});
}

// Those that were asked for while another map was in use refer to other zones: their senders
// know of the change.
std::size_t ControlLoop::take_commands() noexcept {
  std::size_t count = 0;
  if (freed_.exchange(false, std::memory_order_acquire)) {
    Command& freed = commands_[count++] = {};
    freed.kind = Command::Kind::kMapFreed;
    freed.id = kOwnCommand;
  }
  if (ports_.commands == nullptr) return count;
  const std::uint32_t map = ports_.maps.map().number;
  for (std::size_t i = count; i < commands_.size() && ports_.commands->pop(commands_[count]); ++i) {
    count += commands_[count].map == 0 || commands_[count].map == map;
  }
  ports_.overload.deferred_commands += ports_.commands->size() > 0;
  return count;
}

std::size_t ControlLoop::take_corrections(std::int64_t now_ns) noexcept {
  std::size_t count = 0;
  while (count < corrections_.size()) {
    const PoseCorrection* const next = ports_.logged_corrections.peek();
    if (next == nullptr || next->received_ns > now_ns) break;
    ports_.logged_corrections.pop(corrections_[count++]);
  }
  while (ports_.poses != nullptr && count < corrections_.size() &&
         ports_.poses->pop(corrections_[count])) {
    corrections_[count++].received_ns = now_ns;
  }
  return count;
}

// Stamped as long before the cycle's time as they happened before the cycle began.
std::size_t ControlLoop::take_edges(std::int64_t now_ns, std::int64_t began_ns) noexcept {
  std::size_t count = 0;
  while (ports_.edges != nullptr && count < edges_.size() && ports_.edges->pop(edges_[count])) {
    LineEdge& edge = edges_[count++];
    edge.stamp_ns = now_ns - std::max<std::int64_t>(0, began_ns - edge.stamp_ns);
  }
  return count;
}

void ControlLoop::answer() noexcept {
  if (ports_.replies == nullptr) return;
  for (CommandReply reply : ports_.maps.map().cycle.replies()) {
    if (reply.id == kOwnCommand) continue;
    reply.map = ports_.maps.map().number;
    ports_.overload.lost_replies += !ports_.replies->push(reply);
  }
}

void ControlLoop::publish(const CycleInput& input, std::int64_t began_ns,
                          std::int64_t offset_ns) noexcept {
  const Residency& memory = ports_.maps.map().memory;
  ports_.notes.after_cycle(record_of(input.now_ns, ports_.maps.map().cycle.state(), memory));
  status_.now_ns = input.now_ns;
  status_.began_ns = began_ns;
  status_.clock_offset_ns = offset_ns;
  status_.state = ports_.maps.map().cycle.state();
  status_.budget = memory.limits().budget;
  status_.charged = memory.charged();
  status_.max_signatures = memory.limits().max_signatures;
  status_.charged_sum = memory.used_sum();
  status_.resident_sum = memory.resident_sum();
  status_.residency = memory.counters();
  status_.odometry = ports_.maps.map().cycle.odometry_counters();
  status_.filter = ports_.maps.map().cycle.filter_counters();
  status_.overload = ports_.overload;
  status_.frozen = memory.frozen();
  const ThreadUsage usage = thread_usage();
  status_.minor_faults = usage.minor_faults - usage_at_start_.minor_faults;
  status_.major_faults = usage.major_faults - usage_at_start_.major_faults;
  status_.voluntary_switches = usage.voluntary_switches - usage_at_start_.voluntary_switches;
  status_.involuntary_switches = usage.involuntary_switches - usage_at_start_.involuntary_switches;
  ports_.status.store(status_);
}

void ControlLoop::measure(const CycleInput& input, std::uint64_t cycle,
                          const std::array<std::int64_t, 4>& marks) noexcept {
  const std::int64_t took_ns = marks[3] - marks[0];
  work_.add(took_ns);
  if (took_ns > status_.worst.ns) {
    WorstCycle& worst = status_.worst;
    worst.cycle = cycle;
    worst.ns = took_ns;
    worst.step_ns = 0;
    for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
      if (marks[i + 1] - marks[i] <= worst.step_ns) continue;
      worst.step_ns = marks[i + 1] - marks[i];
      worst.step = static_cast<CycleStep>(i);
    }
    worst.frames = static_cast<std::uint32_t>(input.frames.size());
    worst.corrections = static_cast<std::uint32_t>(input.corrections.size());
    worst.loads = static_cast<std::uint32_t>(input.loads.size());
    worst.commands = static_cast<std::uint32_t>(input.commands.size());
  }
  if (cycle % kFiguresEvery == 0) {
    status_.wakeup = wakeup_.figures();
    status_.cycle = work_.figures();
  }
}

}  // namespace zonepack
