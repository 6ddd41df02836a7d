// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "runtime/calibrate/expected_motion.hpp"
#include "runtime/listen/frame_feed.hpp"

namespace zonepack {

// The command line of `zoned listen`; empty paths: not given.
struct ListenArguments {
  std::string config = {};
  FeedChoice feed = {};
  std::optional<double> duration_s = {};
  std::string truth = {}, corrections = {};  // of a log
  std::string json = {};                     // "-": standard output
  std::optional<ExpectedMotion> expected = {};
  bool once = false;
};

// Shows what the settings decode from a bus or a log, and what is probably wrong with them, until
// the source or the duration ends, or SIGINT or SIGTERM comes. On a terminal the picture is drawn
// again in place; elsewhere it is printed once a second, and of a whole log once. Returns the exit
// code: 0; 1 when something could not be read or written, none of the frames that odometry reads
// came before the source or the duration ended, or the robot did not move as expected; 2 for
// arguments that do not go together.
int run_listen(const ListenArguments& arguments);

}  // namespace zonepack
