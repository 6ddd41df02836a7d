// SPDX-License-Identifier: Apache-2.0
#include "platform/process/wakeup.hpp"

#include <semaphore.h>

#include <cerrno>
#include <ctime>

namespace zonepack {

struct Wakeup::Impl {
  sem_t semaphore;
};

Wakeup::Wakeup() : impl_(std::make_unique<Impl>()) { sem_init(&impl_->semaphore, 0, 0); }
Wakeup::~Wakeup() { sem_destroy(&impl_->semaphore); }

void Wakeup::post() noexcept { sem_post(&impl_->semaphore); }

void Wakeup::wait_until(std::int64_t monotonic_ns) noexcept {
  timespec until{};
  until.tv_sec = static_cast<time_t>(monotonic_ns / 1'000'000'000);
  until.tv_nsec = static_cast<long>(monotonic_ns % 1'000'000'000);
  while (sem_clockwait(&impl_->semaphore, CLOCK_MONOTONIC, &until) != 0 && errno == EINTR) {
  }
  while (sem_trywait(&impl_->semaphore) == 0) {
  }
}

}  // namespace zonepack
