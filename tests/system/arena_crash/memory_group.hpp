// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

namespace zonepack::test_support {

// A memory cgroup (version 1 or 2) of its own, for as long as the object lives. Needs root.
class MemoryGroup {
 public:
  // Nothing where this machine does not let us make one.
  static std::optional<MemoryGroup> make(const std::string& name, std::uint64_t limit_bytes) {
    for (const bool v2 : {false, true}) {
      const std::filesystem::path root = v2 ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
      if (!std::filesystem::exists(root / (v2 ? "cgroup.controllers" : "memory.failcnt"))) continue;
      if (v2) write(root / "cgroup.subtree_control", "+memory");
      MemoryGroup group(root / (name + "-" + std::to_string(getpid())), v2);
      std::error_code error;
      std::filesystem::create_directory(group.path_, error);
      const char* const limit = v2 ? "memory.max" : "memory.limit_in_bytes";
      if (!error && write(group.path_ / limit, std::to_string(limit_bytes))) return group;
    }
    return std::nullopt;
  }
  MemoryGroup(MemoryGroup&& other) noexcept : path_(std::move(other.path_)), v2_(other.v2_) {
    other.path_.clear();
  }
  ~MemoryGroup() {
    if (!path_.empty()) rmdir(path_.c_str());
  }

  // The calling process and its later children belong to the group.
  bool join() const { return write(path_ / "cgroup.procs", std::to_string(getpid())); }

  std::uint64_t peak_bytes() const {
    return number(v2_ ? "memory.peak" : "memory.max_usage_in_bytes", "");
  }
  // How often the limit was hit.
  std::uint64_t limit_hits() const {
    return v2_ ? number("memory.events", "max ") : number("memory.failcnt", "");
  }

 private:
  MemoryGroup(std::filesystem::path path, bool v2) : path_(std::move(path)), v2_(v2) {}
  static bool write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path);
    file << text << std::flush;
    return file.good();
  }
  std::uint64_t number(const char* file, const std::string& before) const {
    std::ifstream in(path_ / file);
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with(before)) return std::stoull(line.substr(before.size()));
    }
    return 0;
  }

  std::filesystem::path path_;
  bool v2_;
};

}  // namespace zonepack::test_support
