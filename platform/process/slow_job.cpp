// SPDX-License-Identifier: Apache-2.0
#include "platform/process/slow_job.hpp"

#include <utility>

namespace zonepack {

Result<void> SlowJob::start(Work work) {
  if (running()) return ErrorCode::kBusy;
  done_.store(false, std::memory_order_relaxed);
  ThreadSettings settings;
  settings.name = name_;
  Result<Thread> thread = Thread::start(settings, true, [this, work = std::move(work)] {
    result_ = work();
    done_.store(true, std::memory_order_release);
  });
  if (!thread) return thread.error();
  thread_ = std::move(thread).value();
  return {};
}

std::optional<Result<std::uint64_t>> SlowJob::poll() {
  if (!running() || !done_.load(std::memory_order_acquire)) return std::nullopt;
  thread_.join();
  return std::exchange(result_, std::nullopt);
}

}  // namespace zonepack
