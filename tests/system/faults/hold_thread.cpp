// SPDX-License-Identifier: Apache-2.0
// usage: hold_thread PID NAME SECONDS: one thread of a process stands still for so long, or until
// the process is killed, as one does that waits in the kernel for a disk which does not answer; the
// others run on. A thread that is not there yet is waited for, 10 s at most, and stands still when
// it first opens or reads a file.
#include <dirent.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <set>
#include <string>

namespace {

std::set<pid_t> threads_of(const std::string& process) {
  std::set<pid_t> found;
  DIR* const tasks = ::opendir(("/proc/" + process + "/task").c_str());
  if (tasks == nullptr) return found;
  while (const dirent* const entry = ::readdir(tasks)) found.insert(std::atoi(entry->d_name));
  ::closedir(tasks);
  found.erase(0);  // . and ..
  return found;
}

pid_t find_thread(const std::string& process, const std::string& name) {
  for (const pid_t thread : threads_of(process)) {
    std::string told;
    std::getline(std::ifstream("/proc/" + process + "/task/" + std::to_string(thread) + "/comm"),
                 told);
    if (told == name) return thread;
  }
  return 0;
}

// A signal that a traced thread was about to get reaches it; what stopped it otherwise is over.
void let_go_on(pid_t thread, int status) {
  const bool signal = WIFSTOPPED(status) && status >> 16 == 0 && WSTOPSIG(status) != SIGTRAP;
  ::ptrace(PTRACE_CONT, thread, nullptr, signal ? WSTOPSIG(status) : 0);
}

// The next thread that the process makes, stopped before its first instruction: it may end in a
// millisecond. Every thread that could make it is traced from now on.
pid_t wait_for_thread(const std::string& process) {
  const std::set<pid_t> before = threads_of(process);
  for (const pid_t thread : before) {
    ::ptrace(PTRACE_SEIZE, thread, nullptr, PTRACE_O_TRACECLONE | PTRACE_O_TRACESYSGOOD);
  }
  const std::time_t until = std::time(nullptr) + 10;
  while (std::time(nullptr) < until) {
    int status = 0;
    const pid_t thread = ::waitpid(-1, &status, __WALL | WNOHANG);
    if (thread < 0) return 0;
    if (thread == 0) {
      ::usleep(1000);
    } else if (!before.contains(thread)) {
      return WIFSTOPPED(status) ? thread : 0;
    } else {
      let_go_on(thread, status);
    }
  }
  return 0;
}

// From one stop of the thread to its next call of the kernel for a file. False once it has ended.
bool run_to_a_file(pid_t thread) {
  int status = 0;
  for (;;) {
    if (::ptrace(PTRACE_SYSCALL, thread, nullptr, nullptr) != 0 ||
        ::waitpid(thread, &status, __WALL) != thread || !WIFSTOPPED(status)) {
      return false;
    }
    __ptrace_syscall_info call{};
    if (::ptrace(PTRACE_GET_SYSCALL_INFO, thread, sizeof call, &call) <= 0) return false;
    if (call.op != PTRACE_SYSCALL_INFO_ENTRY) continue;
    for (const long number : {SYS_openat, SYS_read, SYS_pread64}) {
      if (static_cast<long>(call.entry.nr) == number) return true;
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::fputs("usage: hold_thread PID NAME SECONDS\n", stderr), 2;
  pid_t thread = find_thread(argv[1], argv[2]);
  int status = 0;
  if (thread == 0) {
    thread = wait_for_thread(argv[1]);
    if (thread == 0) return std::fprintf(stderr, "hold_thread: no thread %s\n", argv[2]), 1;
    if (!run_to_a_file(thread)) {
      return std::fprintf(stderr, "hold_thread: %s has ended\n", argv[2]), 1;
    }
  } else if (::ptrace(PTRACE_SEIZE, thread, nullptr, PTRACE_O_TRACESYSGOOD) != 0) {
    return std::perror("hold_thread: ptrace"), 77;
  } else if (::ptrace(PTRACE_INTERRUPT, thread, nullptr, nullptr) != 0 ||
             ::waitpid(thread, &status, __WALL) != thread) {
    return std::perror("hold_thread: stop"), 1;
  }
  // A process has ended for its parent only when its traced threads are reaped.
  for (int turns = static_cast<int>(std::atof(argv[3]) * 100); turns > 0;) {
    const pid_t other = ::waitpid(-1, &status, __WALL | WNOHANG);
    if (other < 0 || (other == thread && !WIFSTOPPED(status))) return 0;
    if (other > 0 && other != thread) {
      let_go_on(other, status);
    } else {
      --turns;
      ::usleep(10'000);
    }
  }
  ::ptrace(PTRACE_DETACH, thread, nullptr, nullptr);
  return 0;
}
