// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/jobs.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace zonepack {

void run_jobs(std::size_t count, unsigned jobs, const std::function<void(std::size_t)>& work) {
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  const std::size_t threads = std::min<std::size_t>(jobs == 0 ? cores : jobs, count);
  std::atomic<std::size_t> next = 0;
  const auto run = [&] {
    for (std::size_t i; (i = next++) < count;) work(i);
  };
  std::vector<std::jthread> others;
  for (std::size_t i = 1; i < threads; ++i) others.emplace_back(run);
  run();
}

}  // namespace zonepack
