// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "runtime/listen/listener.hpp"

namespace zonepack {

// How the picture is shown.
struct ListenStyle {
  std::string source = {};       // as the title names it
  std::string instruction = {};  // what somebody is to do with the robot; may be empty
  std::string note = {};         // what has changed at the bus; may be empty
  bool color = false;
};

// The picture as a table of signals, and below it what they mean; each line ends with a line feed.
std::string listen_text(const ListenPicture& picture, const ListenStyle& style);

// The text in lines of at most `columns` code points, longer ones broken at blanks, and of these
// the first `rows`.
std::string fitted(const std::string& text, int columns, int rows);

// The picture as one JSON object, with what odometry missed (may be empty).
std::string listen_json(const ListenPicture& picture, const std::string& source,
                        const std::string& mismatch);

}  // namespace zonepack
