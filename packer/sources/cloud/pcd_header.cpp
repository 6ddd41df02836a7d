// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/cloud/pcd_header.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace zonepack::packer {
namespace {

constexpr std::size_t kLongestHeader = 64 << 10;
constexpr std::size_t kMostFields = 64;
constexpr std::uint32_t kMostElements = 4096;

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

class HeaderReader {
 public:
  HeaderReader(std::FILE* file, const std::string& name) : file_(file), name_(name) {}

  PcdHeader read() {
    while (next_line()) {
      const std::vector<std::string> words = words_of(line_);
      if (words.empty() || words[0][0] == '#') continue;
      const std::vector<std::string> values(words.begin() + 1, words.end());
      if (take(words[0], values)) break;
    }
    finish();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw std::runtime_error(name_ + ", line " + std::to_string(number_) + ": " + problem);
  }

  bool next_line() {
    line_.clear();
    ++number_;
    for (int c; (c = std::getc(file_)) != EOF;) {
      if (++bytes_ > kLongestHeader)
        fail("expected DATA within 64 KiB, found no end of the header");
      if (c == '\n') {
        if (!line_.empty() && line_.back() == '\r') line_.pop_back();
        return true;
      }
      line_ += static_cast<char>(c);
    }
    fail("expected DATA ascii, binary or binary_compressed, found the end of the file");
  }

  std::uint64_t whole(const std::string& word, std::uint64_t most) const {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value > most) {
      fail("expected a whole number of at most " + std::to_string(most) + ", found '" +
           word.substr(0, 40) + "'");
    }
    return value;
  }

  // True at DATA, the last line.
  bool take(const std::string& key, const std::vector<std::string>& values) {
    if (key == "FIELDS" || key == "COLUMNS") {
      if (values.empty() || values.size() > kMostFields) fail("expected 1 to 64 FIELDS");
      header_.fields.resize(values.size());
      for (std::size_t i = 0; i < values.size(); ++i) header_.fields[i].name = values[i];
    } else if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
      if (values.size() != header_.fields.size() || values.empty()) {
        fail("expected " + key + " of each of the " + std::to_string(header_.fields.size()) +
             " FIELDS, found " + std::to_string(values.size()));
      }
      for (std::size_t i = 0; i < values.size(); ++i)
        take_column(key, values[i], header_.fields[i]);
    } else if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS") {
      if (values.size() != 1) fail("expected one number behind " + key);
      const std::uint64_t value = whole(values[0], std::uint64_t{1} << 40);
      if (key == "WIDTH") width_ = value;
      if (key == "HEIGHT") height_ = value;
      if (key == "POINTS") points_ = value;
    } else if (key == "VIEWPOINT") {
      if (values.size() != 7) fail("expected 7 numbers behind VIEWPOINT");
      for (std::size_t i = 0; i < 7; ++i) header_.viewpoint[i] = number(values[i]);
    } else if (key == "DATA") {
      if (values.size() != 1) fail("expected one word behind DATA");
      if (values[0] == "ascii") {
        header_.data = PcdHeader::Data::kAscii;
      } else if (values[0] == "binary") {
        header_.data = PcdHeader::Data::kBinary;
      } else if (values[0] == "binary_compressed") {
        header_.data = PcdHeader::Data::kCompressed;
      } else {
        fail("expected DATA ascii, binary or binary_compressed, found '" + values[0].substr(0, 40) +
             "'");
      }
      return true;
    } else if (key == "VERSION") {
      if (values.size() != 1 || (values[0] != "0.7" && values[0] != ".7" && values[0] != "0.6" &&
                                 values[0] != ".6" && values[0] != "0.5" && values[0] != ".5")) {
        fail("expected VERSION 0.7, found '" + (values.empty() ? "" : values[0].substr(0, 40)) +
             "'");
      }
    } else {
      fail("expected a line of a PCD header, found '" + key.substr(0, 40) + "'");
    }
    return false;
  }

  double number(const std::string& word) const {
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
      fail("expected a number, found '" + word.substr(0, 40) + "'");
    }
    return value;
  }

  void take_column(const std::string& key, const std::string& word, PcdHeader::Field& field) {
    if (key == "TYPE") {
      if (word != "F" && word != "I" && word != "U")
        fail("expected TYPE F, I or U, found '" + word.substr(0, 40) + "'");
      field.type = word[0];
      return;
    }
    const std::uint64_t value = whole(word, kMostElements);
    if (key == "COUNT") {
      field.count = static_cast<std::uint32_t>(value);
    } else if (value == 1 || value == 2 || value == 4 || value == 8) {
      field.size = static_cast<std::uint32_t>(value);
    } else {
      fail("expected SIZE 1, 2, 4 or 8, found " + word);
    }
  }

  void finish() {
    if (header_.fields.empty()) fail("expected FIELDS before DATA");
    for (PcdHeader::Field& field : header_.fields) {
      if (field.type == 'F' && field.size < 4) {
        fail("field " + field.name + ": expected floats of 4 or 8 bytes, found " +
             std::to_string(field.size));
      }
      field.offset = header_.record_bytes;
      header_.record_bytes += std::uint64_t{field.size} * field.count;
    }
    const bool shaped = width_ && height_;
    if (shaped && *height_ != 0 && *width_ > (std::uint64_t{1} << 40) / *height_) {
      fail("WIDTH times HEIGHT is too large");
    }
    if (!points_ && !shaped) fail("expected POINTS, or WIDTH and HEIGHT");
    header_.points = points_ ? *points_ : *width_ * *height_;
    if (points_ && shaped && *width_ * *height_ != *points_) {
      fail("POINTS says " + std::to_string(*points_) + ", WIDTH times HEIGHT " +
           std::to_string(*width_ * *height_));
    }
  }

  std::FILE* file_;
  const std::string& name_;
  std::string line_;
  std::size_t number_ = 0, bytes_ = 0;
  std::optional<std::uint64_t> width_, height_, points_;
  PcdHeader header_;
};

}  // namespace

const PcdHeader::Field* PcdHeader::find(std::initializer_list<const char*> names) const {
  for (const char* name : names) {
    const auto field = std::ranges::find(fields, name, &Field::name);
    if (field != fields.end() && field->count == 1) return &*field;
  }
  return nullptr;
}

bool begins_as_pcd(std::string_view bytes) {
  while (!bytes.empty()) {  // comments and empty lines come first
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    const std::string_view line = bytes.substr(0, end);
    if (line.starts_with("VERSION") || line.starts_with("FIELDS")) return true;
    if (line.starts_with("# .PCD")) return true;
    if (!line.empty() && line[0] != '#' && line[0] != '\r') return false;
    bytes.remove_prefix(std::min(bytes.size(), end + 1));
  }
  return false;
}

PcdHeader read_pcd_header(std::FILE* file, const std::string& name) {
  return HeaderReader(file, name).read();
}

}  // namespace zonepack::packer
