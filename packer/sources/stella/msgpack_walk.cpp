// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/stella/msgpack_walk.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace zonepack::packer {

// The interface of nlohmann::json's event parser. Values that nothing asks for are passed over.
class MsgpackWalk::Handler {
 public:
  explicit Handler(MsgpackWalk& walk) : walk_(walk) {}

  bool null() { return value(); }
  bool boolean(bool) { return value(); }
  bool number_integer(std::int64_t n) { return number({static_cast<double>(n), true, n}); }
  bool number_unsigned(std::uint64_t n) {
    constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    return number({static_cast<double>(n), true, static_cast<std::int64_t>(std::min(n, kMost))});
  }
  bool number_float(double n, const std::string&) { return number({n, false, 0}); }
  bool string(std::string& text) {
    require_inside();
    walk_.text(text);
    return value();
  }
  bool binary(nlohmann::json::binary_t&) { return value(); }
  bool start_object(std::size_t) { return open(false); }
  bool start_array(std::size_t) { return open(true); }
  bool key(std::string& key) {
    if (key.size() > 4096) walk_.fail("expected keys of at most 4096 bytes, found a longer one");
    walk_.levels_.back().key = key;
    return true;
  }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception&) {
    walk_.fail("is not whole or not MessagePack: nothing that can be read at byte " +
               std::to_string(position) + "; copy the file again, or save the map again");
  }

 private:
  bool number(const Number& n) {
    require_inside();
    walk_.number(n);
    return value();
  }
  // The file as a whole is a map.
  void require_inside() {
    if (walk_.levels_.empty()) walk_.fail("is no map of stella_vslam: expected a map of keys");
  }
  bool value() {
    require_inside();
    walk_.passed();
    return true;
  }
  bool open(bool array) {
    if (walk_.levels_.empty() && array) require_inside();
    walk_.open(array);
    return true;
  }
  bool close() {
    walk_.close();
    return true;
  }

  MsgpackWalk& walk_;
};

void MsgpackWalk::fail(const std::string& problem) const {
  throw std::runtime_error(file_ + ": " + problem);
}

void MsgpackWalk::open(bool array) {
  if (levels_.size() == kDeepest) {
    fail("expected maps and arrays of at most 8 levels, found more");
  }
  levels_.push_back({array, 0, {}});
  opened();
}

void MsgpackWalk::close() {
  closed();
  levels_.pop_back();
  if (!levels_.empty()) passed();
}

void MsgpackWalk::passed() {
  if (levels_.back().array) ++levels_.back().index;
}

void MsgpackWalk::walk(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(path.c_str(), "rb"),
                                                           &std::fclose);
  if (!in) fail(std::string("cannot be read: ") + std::strerror(errno));
  Handler handler(*this);
  nlohmann::json::sax_parse(in.get(), &handler, nlohmann::json::input_format_t::msgpack);
  if (std::ferror(in.get()) != 0) fail("cannot be read whole");
}

}  // namespace zonepack::packer
