// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace zonepack {

// The terminal that standard output leads to.
struct TerminalSize {
  int columns = 80;
  int rows = 24;
};

bool output_is_terminal() noexcept;
TerminalSize terminal_size() noexcept;

// A full-screen view for the lifetime of the object: alternate screen, no cursor, no echo of keys.
// The terminal is put back by the destructor, and when SIGINT, SIGTERM, SIGHUP or SIGQUIT asks the
// program to end: from then on ended() is true. One at a time.
class FullScreen {
 public:
  FullScreen() noexcept;
  ~FullScreen();
  FullScreen(const FullScreen&) = delete;
  FullScreen& operator=(const FullScreen&) = delete;

  // Shows `lines`, each with its '\n', from the top; what stood there before is gone.
  void show(std::string_view lines) noexcept;

  // Waits for a key at most timeout_ms; '\0' when none was pressed.
  char key(int timeout_ms) noexcept;

  bool ended() const noexcept;
};

// Without a full screen: SIGINT and SIGTERM ask to end, and are seen here.
void watch_for_end() noexcept;
bool end_was_asked() noexcept;

}  // namespace zonepack
