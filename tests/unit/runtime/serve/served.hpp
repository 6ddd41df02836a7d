// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "tests/unit/runtime/serve/fake_run.hpp"

namespace zonepack::testing_support {

// A run that a server serves.
class Served : public testing::Test {
 protected:
  FakeRun run;

  // A control thread that answers every command with `answer`.
  template <typename Answer>
  auto control(Answer answer) {
    return [this, answer] {
      Command command;
      while (run.commands.pop(command)) {
        CommandReply reply = answer(command);
        reply.id = command.id;
        run.replies.push(reply);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
  }
};

}  // namespace zonepack::testing_support
