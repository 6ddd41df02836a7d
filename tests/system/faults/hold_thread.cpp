// SPDX-License-Identifier: Apache-2.0
// usage: hold_thread PID NAME SECONDS: one thread of a process stands still for so long, or until
// the process is killed, as one does that waits in the kernel for a disk which does not answer; the
// others run on.
#include <dirent.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

namespace {

pid_t find_thread(const std::string& process, const std::string& name) {
  const std::string folder = "/proc/" + process + "/task";
  DIR* const tasks = ::opendir(folder.c_str());
  if (tasks == nullptr) return 0;
  pid_t found = 0;
  while (const dirent* const entry = ::readdir(tasks)) {
    std::string told;
    std::getline(std::ifstream(folder + "/" + entry->d_name + "/comm"), told);
    if (told == name) found = std::atoi(entry->d_name);
  }
  ::closedir(tasks);
  return found;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::fputs("usage: hold_thread PID NAME SECONDS\n", stderr), 2;
  const pid_t thread = find_thread(argv[1], argv[2]);
  if (thread == 0) return std::fprintf(stderr, "hold_thread: no thread %s\n", argv[2]), 1;
  if (::ptrace(PTRACE_SEIZE, thread, nullptr, nullptr) != 0) {
    return std::perror("hold_thread: ptrace"), 77;
  }
  int status = 0;
  if (::ptrace(PTRACE_INTERRUPT, thread, nullptr, nullptr) != 0 ||
      ::waitpid(thread, &status, __WALL) != thread) {
    return std::perror("hold_thread: stop"), 1;
  }
  // A process has ended for its parent only when its traced threads are reaped.
  for (int turns = static_cast<int>(std::atof(argv[3]) * 100); turns > 0; --turns) {
    if (::waitpid(thread, &status, __WALL | WNOHANG) != 0) return 0;
    ::usleep(10'000);
  }
  ::ptrace(PTRACE_DETACH, thread, nullptr, nullptr);
  return 0;
}
