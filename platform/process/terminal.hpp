// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace zonepack {

// The terminal that standard output is connected to.
struct TerminalSize {
  int columns = 80;
  int rows = 24;
};

bool output_is_terminal() noexcept;
TerminalSize terminal_size() noexcept;

// A full-screen view for the lifetime of the object: alternate screen, no cursor, no echo of keys.
// The destructor restores the terminal, and so does a SIGINT, SIGTERM, SIGHUP or SIGQUIT: from then
// on ended() is true. Only one may exist at a time.
class FullScreen {
 public:
  FullScreen() noexcept;
  ~FullScreen();
  FullScreen(const FullScreen&) = delete;
  FullScreen& operator=(const FullScreen&) = delete;

  // Shows `lines`, each with its '\n', from the top, replacing what was shown before.
  void show(std::string_view lines) noexcept;

  // Waits at most timeout_ms for a key; '\0' when none was pressed.
  char key(int timeout_ms) noexcept;

  bool ended() const noexcept;
};

// Without a full screen: records SIGINT and SIGTERM as a request to end.
void watch_for_end() noexcept;
bool end_was_asked() noexcept;

}  // namespace zonepack
