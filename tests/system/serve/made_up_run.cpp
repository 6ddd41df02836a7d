// SPDX-License-Identifier: Apache-2.0
// usage: made_up_run SOCKET: serves three rooms in which nothing moves, for zonectl to be tried on,
// until its standard input ends.
#include <unistd.h>

#include <cstdio>

#include "tests/unit/runtime/serve/fake_run.hpp"

using namespace zonepack;

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  testing_support::FakeRun run;
  run.settings.socket = argv[1];
  run.ports.dump = [](BoundedWriter& to) -> Result<std::uint64_t> {
    const auto written = to.write(std::as_bytes(std::span("frames", 6)));
    if (!written) return written.error();
    return std::uint64_t{6};
  };
  LiveStatus status;
  status.state.zone = 0;
  status.state.pose.valid = true;
  status.state.pose.T_map_base = {1, 2, 0};
  status.budget = 8 * kMiB;
  run.status.store(status);
  if (!run.open()) return 1;
  run.load(1);
  run.happen(EventKind::kNotKeepingUp, 0);
  std::uint64_t poses = 0;
  const testing_support::Meanwhile controlling([&] {
    Command command;
    while (run.commands.pop(command)) {
      CommandReply reply;
      reply.id = command.id;
      if (command.zone == 2) reply.error = {ErrorCode::kNoRoom, 0};
      run.replies.push(reply);
    }
    PoseCorrection pose;
    while (run.poses.pop(pose)) status.filter.used = ++poses;
    run.status.store(status);
    run.happen(EventKind::kZoneWanted, 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  });
  const testing_support::Serving serving(run);
  std::puts("ready");
  std::fflush(stdout);
  char byte = 0;
  while (::read(STDIN_FILENO, &byte, 1) > 0) {
  }
}
