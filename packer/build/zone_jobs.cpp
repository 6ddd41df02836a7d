// SPDX-License-Identifier: Apache-2.0
#include "packer/build/zone_jobs.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace zonepack::packer {

std::size_t run_zone_jobs(std::size_t count, unsigned jobs, const MapSource* source,
                          const std::function<void(MapSource*, std::size_t)>& work) {
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  const std::size_t used =
      std::clamp<std::size_t>(jobs == 0 ? cores : jobs, 1, std::max<std::size_t>(count, 1));
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex mutex;
  const auto run = [&] {
    try {
      const std::unique_ptr<MapSource> own = source != nullptr ? source->reopen() : nullptr;
      for (std::size_t i; (i = next++) < count;) work(own.get(), i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::jthread> threads;
  for (std::size_t i = 1; i < used; ++i) threads.emplace_back(run);
  run();
  threads.clear();
  if (failure) std::rethrow_exception(failure);
  return used;
}

}  // namespace zonepack::packer
