// SPDX-License-Identifier: Apache-2.0
// usage: memory_watch PID: looks a thousand times a second at what a process has resident (statm)
// and locked (status), and once a second at its share (smaps_rollup), until it ends. Prints one
// JSON object; the least and most of each from half a second after memory was locked until a
// quarter of a second before the end: outside of that it is being reserved or given back. "parts"
// says what was resident at the first of these looks (smaps).
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <string_view>

#include "platform/process/clock.hpp"

namespace {

using zonepack::monotonic_ns;

class ProcFile {
 public:
  ProcFile(const std::string& process, const char* name)
      : fd_(open(("/proc/" + process + "/" + name).c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~ProcFile() {
    if (fd_ >= 0) close(fd_);
  }
  ProcFile(const ProcFile&) = delete;
  ProcFile& operator=(const ProcFile&) = delete;

  // Empty when the process is gone.
  std::string_view read() {
    const ssize_t size = fd_ < 0 ? -1 : pread(fd_, text_.data(), text_.size(), 0);
    return {text_.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
  }

 private:
  int fd_;
  std::array<char, 8192> text_{};
};

std::uint64_t number_at(std::string_view text, std::size_t at) {
  while (at < text.size() && (text[at] == ' ' || text[at] == '\t')) ++at;
  std::uint64_t value = 0;
  if (at < text.size()) std::from_chars(text.data() + at, text.data() + text.size(), value);
  return value;
}

// Of a line "KEY:  123 kB", in bytes.
std::uint64_t kib_after(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(key);
  return at == std::string_view::npos ? 0 : number_at(text, at + key.size()) * 1024;
}

struct Range {
  std::uint64_t least = UINT64_MAX, most = 0, samples = 0;
  void add(std::uint64_t value) {
    least = std::min(least, value);
    most = std::max(most, value);
    ++samples;
  }
  void print(const char* name) const {
    std::printf("\"%s\": {\"least\": %llu, \"most\": %llu, \"samples\": %llu}", name,
                static_cast<unsigned long long>(samples > 0 ? least : 0),
                static_cast<unsigned long long>(most), static_cast<unsigned long long>(samples));
  }
};

// Resident bytes by what they are for.
struct Parts {
  std::uint64_t slots = 0, program = 0, libraries = 0, heap = 0, stacks = 0, other = 0;

  static Parts of(const std::string& process) {
    Parts parts;
    std::ifstream file("/proc/" + process + "/smaps");
    const std::string program = program_of(process);
    std::uint64_t* part = &parts.other;
    bool after_guard = false;  // as the stack of a thread lies
    for (std::string line; std::getline(file, line);) {
      if (line.starts_with("Rss:")) *part += number_at(line, 4) * 1024;
      // A mapping begins: "55d0c0000000-55d0c0021000 rw-p 00000000 00:00 0   [heap]".
      const std::size_t blank = line.find(' ');
      if (blank == std::string::npos || line.substr(0, blank).find('-') == std::string::npos) {
        continue;
      }
      const std::string access = line.substr(blank + 1, 4);
      const std::size_t at = line.find_first_of("/[", blank);
      const std::string name = at == std::string::npos ? "" : line.substr(at);
      if (access == "---p") {
        part = &parts.other;
      } else if (name.starts_with("/memfd:zonepack") || name.starts_with("/memfd:zoned")) {
        part = &parts.slots;
      } else if (name == program) {
        part = &parts.program;
      } else if (name.find(".so") != std::string::npos) {
        part = &parts.libraries;
      } else if (name == "[heap]") {
        part = &parts.heap;
      } else if (name == "[stack]" || (name.empty() && after_guard)) {
        part = &parts.stacks;
      } else {
        part = &parts.other;
      }
      after_guard = access == "---p" && name.empty();
    }
    return parts;
  }

  void print() const {
    std::printf(
        "\"parts\": {\"slots\": %llu, \"program\": %llu, \"libraries\": %llu, "
        "\"heap\": %llu, \"stacks\": %llu, \"other\": %llu}",
        static_cast<unsigned long long>(slots), static_cast<unsigned long long>(program),
        static_cast<unsigned long long>(libraries), static_cast<unsigned long long>(heap),
        static_cast<unsigned long long>(stacks), static_cast<unsigned long long>(other));
  }

 private:
  static std::string program_of(const std::string& process) {
    std::array<char, 4096> path{};
    const ssize_t size =
        readlink(("/proc/" + process + "/exe").c_str(), path.data(), path.size() - 1);
    return {path.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
  }
};

struct Look {
  std::uint64_t resident = 0, locked = 0, share = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: memory_watch PID\n"), 2;
  constexpr std::int64_t kPeriod_ns = 1'000'000, kSettle_ns = 500'000'000;
  const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  ProcFile statm(argv[1], "statm"), status(argv[1], "status");
  Parts parts;
  Range resident, locked, share;
  std::uint64_t most_ever = 0;
  std::array<Look, 256> looks{};  // the newest, not yet counted
  std::int64_t locked_since_ns = 0, first_ns = 0, last_ns = 0;
  std::int64_t next_ns = monotonic_ns();
  for (std::uint64_t turn = 0;; ++turn) {
    const std::string_view sizes = statm.read();
    const std::uint64_t pages = number_at(sizes, std::min(sizes.find(' '), sizes.size()));
    if (pages == 0) break;  // gone, or about to be
    most_ever = std::max(most_ever, pages * page);
    const std::uint64_t held = kib_after(status.read(), "VmLck:");
    const std::int64_t now_ns = monotonic_ns();
    if (held > 0 && locked_since_ns == 0) locked_since_ns = now_ns;
    if (held > 0 && now_ns - locked_since_ns > kSettle_ns) {
      if (first_ns == 0) {
        first_ns = now_ns;
        parts = Parts::of(argv[1]);
      }
      last_ns = now_ns;
      Look& look = looks[turn % looks.size()];
      if (look.locked > 0) {
        resident.add(look.resident);
        locked.add(look.locked);
        if (look.share > 0) share.add(look.share);
      }
      look = {pages * page, held, 0};
      // Opened each time: this file is of the memory before exec() when it was opened before.
      if (turn % 1000 == 0) {
        look.share = kib_after(ProcFile(argv[1], "smaps_rollup").read(), "\nPss:");
      }
    }
    next_ns = std::max(next_ns + kPeriod_ns, monotonic_ns() - kPeriod_ns);
    zonepack::sleep_until_ns(next_ns);
  }
  const double seconds = static_cast<double>(last_ns - first_ns) * 1e-9;
  std::printf("{\"seconds\": %.3f, \"most_resident_ever\": %llu, ", seconds,
              static_cast<unsigned long long>(most_ever));
  resident.print("resident");
  std::printf(", ");
  locked.print("locked");
  std::printf(", ");
  share.print("share");
  std::printf(", ");
  parts.print();
  std::printf("}\n");
  return 0;
}
