// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace zonepack::packer {

// Walks over a MessagePack file once, without keeping it: a class derived from this is called for
// each value and knows by which keys and indices it was reached.
//
// Errors: std::runtime_error with the file and, where bytes are wrong, their place.
// Memory: the keys of the way to the value; at most kDeepest levels, keys of at most 4 KiB.
class MsgpackWalk {
 public:
  static constexpr std::size_t kDeepest = 8;

  explicit MsgpackWalk(std::string file) : file_(std::move(file)) {}
  virtual ~MsgpackWalk() = default;
  void walk(const std::filesystem::path& path);

 protected:
  struct Number {
    double real = 0;
    bool whole = false;        // then:
    std::int64_t integer = 0;  // largest where it does not fit
  };

  virtual void number(const Number& value) = 0;
  virtual void text(const std::string& value) = 0;
  virtual void opened() = 0;  // a map or array; depth() counts it
  virtual void closed() = 0;  // the same, before depth() falls

  // How many maps and arrays the value is in.
  std::size_t depth() const noexcept { return levels_.size(); }
  // The key in the map, or the index in the array, of level 0 (the whole file) and further in.
  const std::string& key_at(std::size_t level) const noexcept { return levels_[level].key; }
  std::size_t index_at(std::size_t level) const noexcept { return levels_[level].index; }

  const std::string& file() const noexcept { return file_; }
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  class Handler;
  struct Level {
    bool array = false;
    std::size_t index = 0;  // of the value that comes next
    std::string key;
  };
  void open(bool array);
  void close();
  void passed();  // a value of the innermost level is over

  std::string file_;
  std::vector<Level> levels_;
};

}  // namespace zonepack::packer
