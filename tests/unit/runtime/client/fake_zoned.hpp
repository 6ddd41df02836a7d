// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "platform/memory/shared_memory.hpp"
#include "platform/process/local_socket.hpp"
#include "runtime/protocol/messages.hpp"

namespace zonepack::test_support {

// The other end of a client's socket, for one client: it passes memory and gives fixed answers.
class FakeZoned {
 public:
  FakeZoned(const std::string& path, const SharedMemory& memory);
  ~FakeZoned();

  // Serves zones 0 and 1 of map `serial` from now on; the client learns it with its next answer.
  void change_map(std::uint32_t serial, std::vector<std::string> names);
  std::atomic<wire::Fault> fault{wire::Fault::None};  // the answer to everything from now on
  std::atomic<int> answers_after_ms{0};
  std::atomic<std::uint32_t> epoch{0};         // of the memory while its map is in use
  std::atomic<std::int64_t> pose_stamp_ns{0};  // of the last pose in
  std::atomic<std::uint32_t> released{0};

 private:
  void serve();
  void answer(const LocalSocket& client, const wire::Request& request);

  const SharedMemory& memory_;
  LocalListener listener_;
  std::atomic<bool> done_{false};
  std::atomic<bool> tell_change_{false};
  std::atomic<std::uint32_t> serial_{1};
  std::vector<std::string> names_{"corridor", "lobby"};
  std::thread thread_;
};

}  // namespace zonepack::test_support
