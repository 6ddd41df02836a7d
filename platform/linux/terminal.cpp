// SPDX-License-Identifier: Apache-2.0
#include "platform/process/terminal.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <string>

namespace zonepack {
namespace {

volatile sig_atomic_t end_asked = 0;
termios saved_keys;
bool keys_are_saved = false;

void on_end(int) noexcept { end_asked = 1; }

void put(std::string_view bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

bool output_is_terminal() noexcept { return ::isatty(STDOUT_FILENO) == 1; }

TerminalSize terminal_size() noexcept {
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) {
    return {};
  }
  return {size.ws_col, size.ws_row};
}

void watch_for_end() noexcept {
  struct sigaction action {};
  action.sa_handler = on_end;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    ::sigaction(signal, &action, nullptr);
  }
}

bool end_was_asked() noexcept { return end_asked != 0; }

FullScreen::FullScreen() noexcept {
  watch_for_end();
  keys_are_saved = ::tcgetattr(STDIN_FILENO, &saved_keys) == 0;
  if (keys_are_saved) {
    termios keys = saved_keys;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    keys.c_cc[VMIN] = 0;
    keys.c_cc[VTIME] = 0;
    ::tcsetattr(STDIN_FILENO, TCSANOW, &keys);
  }
  put("\x1b[?1049h\x1b[?25l");
}

FullScreen::~FullScreen() {
  put("\x1b[0m\x1b[?25h\x1b[?1049l");
  if (keys_are_saved) ::tcsetattr(STDIN_FILENO, TCSANOW, &saved_keys);
}

void FullScreen::show(std::string_view lines) noexcept {
  std::string frame = "\x1b[H";
  for (const char c : lines) {
    if (c == '\n') {
      frame += "\x1b[K\r\n";
    } else {
      frame += c;
    }
  }
  put(frame + "\x1b[J");
}

char FullScreen::key(int timeout_ms) noexcept {
  pollfd entry{STDIN_FILENO, POLLIN, 0};
  if (::poll(&entry, 1, timeout_ms) <= 0) return '\0';
  char pressed = '\0';
  if (::read(STDIN_FILENO, &pressed, 1) <= 0) ::poll(nullptr, 0, timeout_ms);
  return pressed;
}

bool FullScreen::ended() const noexcept { return end_asked != 0; }

}  // namespace zonepack
