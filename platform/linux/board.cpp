// SPDX-License-Identifier: Apache-2.0
#include "platform/devices/board.hpp"

#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <limits>

namespace zonepack {
namespace {

namespace fs = std::filesystem;

constexpr long kLongestIdleExit_us = 100;

class Board {
 public:
  Board(const BoardNeeds& needs, std::string root) : needs_(needs), root_(std::move(root)) {}

  std::vector<BoardFact> inspect() {
    kernel();
    governor();
    idle_states();
    throttling();
    isolation();
    interrupts();
    limits();
    compaction();
    pages();
    memory_limit();
    return std::move(facts_);
  }

 private:
  std::optional<std::string> line_of(const std::string& path) const {
    std::ifstream file(root_ + path);
    std::string line;
    if (!file || !std::getline(file, line)) return std::nullopt;
    return line;
  }

  std::optional<long> number_of(const std::string& path) const {
    const auto line = line_of(path);
    if (!line) return std::nullopt;
    long value = 0;
    const auto [end, error] = std::from_chars(line->data(), line->data() + line->size(), value);
    if (error != std::errc()) return std::nullopt;
    return value;
  }

  // Folders below `path` whose names begin with `prefix`, and a digit.
  std::vector<std::string> numbered(const std::string& path, const std::string& prefix) const {
    std::vector<std::string> found;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(root_ + path, error)) {
      const std::string name = entry.path().filename();
      if (name.size() > prefix.size() && name.starts_with(prefix) && name[prefix.size()] >= '0' &&
          name[prefix.size()] <= '9') {
        found.push_back(path + "/" + name);
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  void add(std::string name, std::string found, bool good, std::string mend) {
    facts_.push_back({std::move(name), std::move(found), good, good ? "" : std::move(mend)});
  }

  void kernel() {
    utsname name{};
    uname(&name);
    add("kernel", std::string(name.sysname) + " " + name.release + " " + name.machine, true, "");
    const bool preempt_rt = number_of("/sys/kernel/realtime").value_or(0) == 1 ||
                            std::string(name.version).find("PREEMPT_RT") != std::string::npos;
    add("PREEMPT_RT", preempt_rt ? "yes" : "no", preempt_rt,
        "apt install linux-image-rt-$(dpkg --print-architecture) && reboot");
  }

  void governor() {
    std::string others;
    std::size_t known = 0;
    for (const std::string& cpu : numbered("/sys/devices/system/cpu", "cpu")) {
      const auto governor = line_of(cpu + "/cpufreq/scaling_governor");
      if (!governor) continue;
      ++known;
      if (*governor != "performance" && others.find(*governor) == std::string::npos) {
        others += (others.empty() ? "" : ", ") + *governor;
      }
    }
    add("frequency governor",
        known == 0       ? "none"
        : others.empty() ? "performance"
                         : others,
        others.empty(),
        "echo performance | tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor");
  }

  void idle_states() {
    long longest_us = 0;
    std::string which;
    for (const std::string& cpu : numbered("/sys/devices/system/cpu", "cpu")) {
      for (const std::string& state : numbered(cpu + "/cpuidle", "state")) {
        if (number_of(state + "/disable").value_or(0) != 0) continue;
        const long latency_us = number_of(state + "/latency").value_or(0);
        if (latency_us <= longest_us) continue;
        longest_us = latency_us;
        which = state.substr(state.rfind('/') + 1);
      }
    }
    add("idle states",
        which.empty() ? "none" : which + " wakes up in " + std::to_string(longest_us) + " us",
        longest_us <= kLongestIdleExit_us,
        "echo 1 | tee /sys/devices/system/cpu/cpu*/cpuidle/" + which + "/disable");
  }

  void throttling() {
    const auto runtime = number_of("/proc/sys/kernel/sched_rt_runtime_us");
    add("real-time throttling",
        !runtime       ? "unknown"
        : *runtime < 0 ? "off"
                       : std::to_string(*runtime) + " us a second",
        !runtime || *runtime < 0, "sysctl -w kernel.sched_rt_runtime_us=-1");
  }

  static bool lists(const std::string& list, unsigned cpu) {
    std::size_t at = 0;
    while (at < list.size()) {
      unsigned first = 0, last = 0;
      auto parsed = std::from_chars(list.data() + at, list.data() + list.size(), first);
      if (parsed.ec != std::errc()) return false;
      last = first;
      if (parsed.ptr != list.data() + list.size() && *parsed.ptr == '-') {
        parsed = std::from_chars(parsed.ptr + 1, list.data() + list.size(), last);
      }
      if (cpu >= first && cpu <= last) return true;
      at = static_cast<std::size_t>(parsed.ptr - list.data()) + 1;
    }
    return false;
  }

  void isolation() {
    const std::string isolated = line_of("/sys/devices/system/cpu/isolated").value_or("");
    const bool good = needs_.cpu && lists(isolated, *needs_.cpu);
    const std::string cpu = std::to_string(needs_.cpu.value_or(1));
    add("isolated processors", isolated.empty() ? "none" : isolated, good,
        needs_.cpu ? "add to the kernel's command line: isolcpus=" + cpu + " nohz_full=" + cpu +
                         " rcu_nocbs=" + cpu
                   : "set realtime.cpu, such as " + cpu +
                         ", and add to the kernel's command line: isolcpus=" + cpu);
  }

  void interrupts() {
    if (!needs_.cpu) {
      add("interrupts", "no processor of its own", true, "");
      return;
    }
    std::size_t there = 0;
    for (const std::string& irq : numbered("/proc/irq", "")) {
      const auto list = line_of(irq + "/smp_affinity_list");
      there += list && lists(*list, *needs_.cpu);
    }
    const std::string cpu = std::to_string(*needs_.cpu);
    add("interrupts", std::to_string(there) + " may run on processor " + cpu, there == 0,
        "for f in /proc/irq/*/smp_affinity_list; do echo 0 > $f; done  # any processor but " + cpu);
  }

  static bool root_user() { return geteuid() == 0; }

  void limits() {
    rlimit memlock{}, priority{};
    getrlimit(RLIMIT_MEMLOCK, &memlock);
    getrlimit(RLIMIT_RTPRIO, &priority);
    const bool any = memlock.rlim_cur == RLIM_INFINITY || root_user();
    add("locked memory", any ? "unlimited" : std::to_string(memlock.rlim_cur) + " bytes",
        any || memlock.rlim_cur >= needs_.locked_bytes,
        "LimitMEMLOCK=infinity in the unit (ulimit -l unlimited)");
    const bool granted = root_user() || priority.rlim_cur >= static_cast<rlim_t>(needs_.priority);
    add("real-time priority", root_user() ? "any" : "up to " + std::to_string(priority.rlim_cur),
        granted, "LimitRTPRIO=" + std::to_string(needs_.priority) + " in the unit (ulimit -r)");
  }

  void compaction() {
    const auto allowed = number_of("/proc/sys/vm/compact_unevictable_allowed");
    add("compaction of locked pages",
        !allowed        ? "unknown"
        : *allowed == 0 ? "off"
                        : "on",
        !allowed || *allowed == 0, "sysctl -w vm.compact_unevictable_allowed=0");
  }

  void pages() {
    const long bytes = sysconf(_SC_PAGESIZE);
    add("page size", std::to_string(bytes) + " bytes", bytes <= 16384,
        "use a kernel with pages of 4 KiB: slots are 16 KiB");
  }

  void memory_limit() {
    const auto cgroup = line_of("/sys/fs/cgroup/memory.max");
    if (!cgroup || *cgroup == "max") {
      add("memory limit of the cgroup", "none", true, "");
      return;
    }
    const auto bytes =
        number_of("/sys/fs/cgroup/memory.max").value_or(std::numeric_limits<long>::max());
    add("memory limit of the cgroup", *cgroup + " bytes",
        static_cast<ByteCount>(bytes) >= needs_.locked_bytes,
        "MemoryMax=" + std::to_string(needs_.locked_bytes) + " or more in the unit");
  }

  const BoardNeeds& needs_;
  std::string root_;
  std::vector<BoardFact> facts_;
};

}  // namespace

std::vector<BoardFact> inspect_board(const BoardNeeds& needs, const std::string& root) {
  return Board(needs, root).inspect();
}

ByteCount machine_memory_bytes(const std::string& root) {
  ByteCount bytes = std::numeric_limits<ByteCount>::max();
  std::ifstream meminfo(root + "/proc/meminfo");
  std::string word;
  ByteCount kib = 0;
  while (meminfo >> word) {
    if (word != "MemTotal:") continue;
    if (meminfo >> kib && kib > 0) bytes = kib * kKiB;
    break;
  }
  // "max" where the cgroup has no limit.
  std::ifstream cgroup(root + "/sys/fs/cgroup/memory.max");
  ByteCount most = 0;
  if (cgroup >> most && most > 0) bytes = std::min(bytes, most);
  return bytes;
}

}  // namespace zonepack
