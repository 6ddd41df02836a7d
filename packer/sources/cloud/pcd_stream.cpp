// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/cloud/pcd_stream.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "packer/sources/cloud/lzf_stream.hpp"
#include "packer/sources/cloud/pcd_header.hpp"
#include "packer/sources/cloud/spool.hpp"

namespace zonepack::packer {
namespace {

using Field = PcdHeader::Field;

// The fields that are carried, in this order: x, y, z, intensity, rgb, ring; null where absent.
using Carried = std::array<const Field*, 6>;
constexpr std::size_t kIntensity = 3, kRgb = 4, kRing = 5;

template <typename T>
T as(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

double value_of(const Field& field, const unsigned char* bytes) {
  if (field.type == 'F') return field.size == 8 ? as<double>(bytes) : as<float>(bytes);
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? as<std::int8_t>(bytes) : as<std::uint8_t>(bytes);
    case 2:
      return is_signed ? as<std::int16_t>(bytes) : as<std::uint16_t>(bytes);
    case 4:
      return is_signed ? as<std::int32_t>(bytes) : as<std::uint32_t>(bytes);
    default:
      return is_signed ? static_cast<double>(as<std::int64_t>(bytes))
                       : static_cast<double>(as<std::uint64_t>(bytes));
  }
}

// A colour is 32 bits, whether the header calls them a float or a number.
std::uint32_t colour_of(const Field& field, const unsigned char* bytes) {
  return field.size == 4 ? as<std::uint32_t>(bytes)
                         : static_cast<std::uint32_t>(value_of(field, bytes));
}

void set(CloudPoint& point, std::size_t which, double value) {
  switch (which) {
    case 0:
      point.x = value;
      break;
    case 1:
      point.y = value;
      break;
    case 2:
      point.z = value;
      break;
    case kIntensity:
      point.intensity = static_cast<float>(value);
      break;
    case kRing:
      point.ring = static_cast<float>(value);
      break;
    default:
      break;
  }
}

class PcdStream : public PointStream {
 public:
  PcdStream(const std::string& path, File file, PcdHeader header)
      : name_(path), file_(std::move(file)), header_(std::move(header)) {
    carried_ = {header_.find({"x"}),
                header_.find({"y"}),
                header_.find({"z"}),
                header_.find({"intensity", "i", "Intensity", "reflectivity"}),
                header_.find({"rgb", "rgba"}),
                header_.find({"ring", "channel", "laser_id"})};
    for (std::size_t i = 0; i < 3; ++i) {
      if (carried_[i] != nullptr) continue;
      throw std::runtime_error(name_ +
                               ": expected fields x, y and z of one element, found none named " +
                               "xyz"[i] + "; its FIELDS are those of another kind of data");
    }
    fields_.wide = carried_[0]->size == 8 || carried_[1]->size == 8 || carried_[2]->size == 8;
    fields_.intensity = carried_[kIntensity] != nullptr;
    fields_.rgb = carried_[kRgb] != nullptr && carried_[kRgb]->size == 4;
    if (!fields_.rgb) carried_[kRgb] = nullptr;
    fields_.ring = carried_[kRing] != nullptr;
    for (const Field& field : header_.fields) {
      const bool taken = std::ranges::find(carried_, &field) != carried_.end();
      if (!taken && field.name != "_") fields_.dropped.push_back(field.name);
    }
  }

  const CloudFields& fields() const noexcept override { return fields_; }
  std::uint64_t size() const noexcept override { return header_.points; }

 protected:
  std::string name_;
  File file_;
  PcdHeader header_;
  Carried carried_{};
  CloudFields fields_;
  std::uint64_t read_ = 0;
};

// All of a text as a number, and whether it is one. What a float of this size cannot hold is
// infinite when it is too large, and 0 when it is too small.
template <typename T>
std::pair<double, bool> read_number(const char* from, const char* end) {
  T value = 0;
  const auto [stop, error] = std::from_chars(from, end, value);
  if (stop != end) return {0, false};
  if (error != std::errc::result_out_of_range) return {value, error == std::errc()};
  const double wide = std::strtod(std::string(from, end).c_str(), nullptr);
  return {std::abs(wide) > 1 ? std::copysign(INFINITY, wide) : 0, true};
}

class AsciiStream : public PcdStream {
 public:
  using PcdStream::PcdStream;

  bool next(CloudPoint& point) override {
    if (read_ == header_.points) return false;
    do {
      read_line();
    } while (line_.find_first_not_of(" \t\r") == line_.npos);
    ++read_;
    const char* at = line_.data();
    const char* const end = at + line_.size();
    for (const Field& field : header_.fields) {
      for (std::uint32_t i = 0; i < field.count; ++i) take(field, i == 0, at, end, point);
    }
    return true;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw std::runtime_error(name_ + ": point " + std::to_string(read_) + " of " +
                             std::to_string(header_.points) + ": " + problem);
  }

  void read_line() {
    line_.clear();
    int c;
    while ((c = std::getc(file_.get())) != EOF && c != '\n') {
      if (line_.size() == (64U << 10)) fail("expected a line of at most 64 KiB");
      line_ += static_cast<char>(c);
    }
    if (c == EOF && line_.empty()) {
      ++read_;
      fail("the file ends before it; copy the file again");
    }
  }

  void take(const Field& field, bool first, const char*& at, const char* end, CloudPoint& point) {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\r')) ++at;
    const char* const begin = at;
    while (at != end && *at != ' ' && *at != '\t' && *at != '\r') ++at;
    if (begin == at)
      fail("expected a number for each field, found " + std::to_string(header_.fields.size()) +
           " fields and too few numbers");
    const auto which = std::ranges::find(carried_, &field);
    if (which == carried_.end() || !first) return;
    const auto index = static_cast<std::size_t>(which - carried_.begin());
    const char* const from = *begin == '+' ? begin + 1 : begin;
    const bool single = field.type == 'F' && field.size == 4;
    const auto [value, whole] =
        single ? read_number<float>(from, at) : read_number<double>(from, at);
    if (!whole) {
      fail("expected a number as " + field.name + ", found '" +
           std::string(begin, std::min(at, begin + 40)) + "'");
    }
    if (index == kRgb) {
      const double whole_number = std::isnan(value) ? 0 : value;
      point.rgb = single ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                         : static_cast<std::uint32_t>(static_cast<std::int64_t>(
                               std::clamp(whole_number, -2147483648.0, 4294967295.0)));
    } else {
      set(point, index, value);
    }
  }

  std::string line_;
};

class BinaryStream : public PcdStream {
 public:
  BinaryStream(const std::string& path, File file, PcdHeader header)
      : PcdStream(path, std::move(file), std::move(header)), record_(header_.record_bytes) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(path, error);
    const auto begin = static_cast<std::uint64_t>(std::ftell(file_.get()));
    const std::uint64_t most = error || bytes < begin ? 0 : (bytes - begin) / header_.record_bytes;
    if (most < header_.points) {
      throw std::runtime_error(name_ + ": expected " + std::to_string(header_.points) +
                               " points of " + std::to_string(header_.record_bytes) +
                               " bytes, found " + std::to_string(most) + "; copy the file again");
    }
  }

  bool next(CloudPoint& point) override {
    if (read_ == header_.points) return false;
    if (std::fread(record_.data(), 1, record_.size(), file_.get()) != record_.size()) {
      throw std::runtime_error(name_ + ": ends too early; copy the file again");
    }
    ++read_;
    for (std::size_t i = 0; i < carried_.size(); ++i) {
      if (carried_[i] == nullptr) continue;
      const unsigned char* const bytes = record_.data() + carried_[i]->offset;
      if (i == kRgb) {
        point.rgb = colour_of(*carried_[i], bytes);
      } else {
        set(point, i, value_of(*carried_[i], bytes));
      }
    }
    return true;
  }

 private:
  std::vector<unsigned char> record_;
};

// Column by column, so each field is read from a place of its own.
class CompressedStream : public PcdStream {
 public:
  CompressedStream(const std::string& path, File file, PcdHeader header)
      : PcdStream(path, std::move(file), std::move(header)), columns_(open_spool()) {
    std::array<unsigned char, 8> sizes{};
    if (std::fread(sizes.data(), 1, sizes.size(), file_.get()) != sizes.size()) {
      throw std::runtime_error(name_ +
                               ": expected the sizes of its compressed data, found the end");
    }
    const std::uint64_t stored = as<std::uint32_t>(sizes.data()),
                        whole = as<std::uint32_t>(sizes.data() + 4);
    if (header_.points > whole / header_.record_bytes ||
        whole != header_.points * header_.record_bytes) {
      throw std::runtime_error(name_ + ": expected " + std::to_string(header_.points) +
                               " points of " + std::to_string(header_.record_bytes) +
                               " bytes, found " + std::to_string(whole) + " bytes");
    }
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(path, error);
    const auto begin = static_cast<std::uint64_t>(std::ftell(file_.get()));
    if (error || bytes < begin || bytes - begin < stored) {
      throw std::runtime_error(name_ + ": its compressed data ends too early; copy the file again");
    }
    if (stored == whole && whole > 0) {
      throw std::runtime_error(name_ +
                               ": its data is stored without compression, which PCL does not "
                               "read either; save it as DATA binary");
    }
    decompress_lzf(file_.get(), stored, columns_.get(), whole, name_);
    file_.reset();
  }

  bool next(CloudPoint& point) override {
    if (read_ == header_.points) return false;
    if (at_ == held_) refill();
    for (std::size_t i = 0; i < carried_.size(); ++i) {
      if (carried_[i] == nullptr) continue;
      const unsigned char* const bytes = buffers_[i].data() + at_ * carried_[i]->size;
      if (i == kRgb) {
        point.rgb = colour_of(*carried_[i], bytes);
      } else {
        set(point, i, value_of(*carried_[i], bytes));
      }
    }
    ++at_;
    ++read_;
    return true;
  }

 private:
  void refill() {
    constexpr std::uint64_t kAtOnce = 4096;
    held_ = static_cast<std::size_t>(std::min(kAtOnce, header_.points - read_));
    at_ = 0;
    for (std::size_t i = 0; i < carried_.size(); ++i) {
      if (carried_[i] == nullptr) continue;
      const std::uint64_t size = carried_[i]->size;
      buffers_[i].resize(held_ * carried_[i]->size);
      read_at(columns_.get(), carried_[i]->offset * header_.points + read_ * size,
              buffers_[i].data(), buffers_[i].size(), name_);
    }
  }

  File columns_;
  std::array<std::vector<unsigned char>, 6> buffers_;
  std::size_t at_ = 0, held_ = 0;
};

}  // namespace

std::unique_ptr<PointStream> open_pcd(const std::string& path) {
  File file = open_file(path);
  PcdHeader header = read_pcd_header(file.get(), path);
  if (header.record_bytes == 0) throw std::runtime_error(path + ": its points have no bytes");
  switch (header.data) {
    case PcdHeader::Data::kAscii:
      return std::make_unique<AsciiStream>(path, std::move(file), std::move(header));
    case PcdHeader::Data::kBinary:
      return std::make_unique<BinaryStream>(path, std::move(file), std::move(header));
    case PcdHeader::Data::kCompressed:
      break;
  }
  return std::make_unique<CompressedStream>(path, std::move(file), std::move(header));
}

}  // namespace zonepack::packer
