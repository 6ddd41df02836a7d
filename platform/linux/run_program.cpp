// SPDX-License-Identifier: Apache-2.0
#include "platform/process/run_program.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

namespace zonepack {
namespace {

Result<int> wait_for(pid_t child) noexcept {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return {ErrorCode::kIo, errno};
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

Result<int> run_program(const std::vector<std::string>& arguments, int stdin_fd, int stdout_fd) {
  ZP_REQUIRE(!arguments.empty());
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  if (const int error = ::posix_spawn_file_actions_init(&actions); error != 0) {
    return {ErrorCode::kIo, error};
  }
  pid_t child = -1;
  int error = ::posix_spawn_file_actions_adddup2(&actions, stdin_fd, STDIN_FILENO);
  if (error == 0) error = ::posix_spawn_file_actions_adddup2(&actions, stdout_fd, STDOUT_FILENO);
  if (error == 0) error = ::posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT) return {ErrorCode::kNotFound, error};
  if (error != 0) return {ErrorCode::kIo, error};
  return wait_for(child);
}

}  // namespace zonepack
