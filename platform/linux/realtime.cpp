// SPDX-License-Identifier: Apache-2.0
#include "platform/process/realtime.hpp"

#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "platform/linux/populate.hpp"

namespace zonepack {
namespace {

struct Start {
  ThreadSettings settings;
  bool allow_ordinary = false;
  std::function<void()> body;
  std::mutex mutex;
  std::condition_variable changed;
  bool ready = false;
  bool realtime = false;
  int error = 0;
};

// Touches this thread's stack, from its guard page up to here.
void populate_stack() noexcept {
  pthread_attr_t attributes;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return;
  void* lowest = nullptr;
  std::size_t bytes = 0, guard = 0;
  pthread_attr_getstack(&attributes, &lowest, &bytes);
  pthread_attr_getguardsize(&attributes, &guard);
  pthread_attr_destroy(&attributes);
  auto* const begin = static_cast<std::byte*>(lowest) + guard;
  const auto* const here = static_cast<std::byte*>(__builtin_frame_address(0));
  populate(begin, static_cast<std::size_t>(here - begin));
}

int set_up(const Start& start, bool& realtime) noexcept {
  const ThreadSettings& settings = start.settings;
  pthread_setname_np(pthread_self(), settings.name);
  if (settings.cpu >= 0) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<unsigned>(settings.cpu), &set);
    if (const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set)) return error;
  }
  if (settings.fifo_priority > 0) {
    sched_param parameters{};
    parameters.sched_priority = settings.fifo_priority;
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    if (error != 0 && !start.allow_ordinary) return error;
    realtime = error == 0;
  }
  populate_stack();
  return 0;
}

void* run(void* argument) {
  const std::unique_ptr<std::shared_ptr<Start>> handed(
      static_cast<std::shared_ptr<Start>*>(argument));
  Start& start = **handed;
  bool realtime = false;
  const int error = set_up(start, realtime);
  {
    const std::lock_guard lock(start.mutex);
    start.ready = true;
    start.realtime = realtime;
    start.error = error;
    start.changed.notify_one();
  }
  if (error == 0) start.body();
  return nullptr;
}

}  // namespace

Result<Thread> Thread::start(const ThreadSettings& settings, bool allow_ordinary,
                             std::function<void()> body) {
  auto start = std::make_shared<Start>();
  start->settings = settings;
  start->allow_ordinary = allow_ordinary;
  start->body = std::move(body);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(
      &attributes, std::max(settings.stack_bytes, static_cast<std::size_t>(PTHREAD_STACK_MIN)));
  auto* const handed = new std::shared_ptr<Start>(start);
  pthread_t handle{};
  const int failed = pthread_create(&handle, &attributes, run, handed);
  pthread_attr_destroy(&attributes);
  if (failed != 0) {
    delete handed;
    return {ErrorCode::kIo, failed};
  }
  Thread thread;
  thread.handle_ = handle;
  std::unique_lock lock(start->mutex);
  start->changed.wait(lock, [&] { return start->ready; });
  thread.realtime_ = start->realtime;
  const int error = start->error;
  lock.unlock();
  if (error != 0) {
    thread.join();
    return {ErrorCode::kIo, error};
  }
  return thread;
}

Thread::Thread(Thread&& other) noexcept
    : handle_(std::exchange(other.handle_, 0)), realtime_(other.realtime_) {}

Thread& Thread::operator=(Thread&& other) noexcept {
  join();
  handle_ = std::exchange(other.handle_, 0);
  realtime_ = other.realtime_;
  return *this;
}

Thread::~Thread() { join(); }

void Thread::join() noexcept {
  if (handle_ != 0) pthread_join(std::exchange(handle_, 0), nullptr);
}

void Thread::interrupt() noexcept {
  if (handle_ == 0) return;
  static const bool handled = [] {
    struct sigaction action {};
    action.sa_handler = [](int) {};  // without SA_RESTART
    return sigaction(SIGUSR2, &action, nullptr) == 0;
  }();
  if (handled) pthread_kill(handle_, SIGUSR2);
}

bool thread_is_realtime() noexcept {
  int policy = 0;
  sched_param parameters{};
  return pthread_getschedparam(pthread_self(), &policy, &parameters) == 0 && policy == SCHED_FIFO;
}

void use_one_heap(std::size_t present_bytes) noexcept {
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_TRIM_THRESHOLD, INT_MAX);
  mallopt(M_MMAP_THRESHOLD, INT_MAX);
  void* const block = std::malloc(present_bytes);
  if (block != nullptr) populate(static_cast<std::byte*>(block), present_bytes);
  std::free(block);
}

void give_back_heap() noexcept { malloc_trim(std::size_t{256} * 1024); }

ThreadUsage thread_usage() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  const auto count = [](long value) { return static_cast<std::uint64_t>(value); };
  return {count(usage.ru_minflt), count(usage.ru_majflt), count(usage.ru_nvcsw),
          count(usage.ru_nivcsw)};
}

std::uint64_t process_peak_bytes() noexcept {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen("/proc/self/status", "re"),
                                                             std::fclose);
  if (!file) return 0;
  std::array<char, 256> line;
  while (std::fgets(line.data(), line.size(), file.get()) != nullptr) {
    unsigned long long kib = 0;
    if (std::sscanf(line.data(), "VmHWM: %llu kB", &kib) == 1) return kib * 1024;
  }
  return 0;
}

}  // namespace zonepack
