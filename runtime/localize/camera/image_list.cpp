// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/image_list.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include "platform/base/counted.hpp"
#include "platform/base/file_kind.hpp"
#include "platform/base/utf8.hpp"
#include "runtime/run/figures/stamp_text.hpp"

namespace zonepack::localize {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostImages = 1'000'000;
constexpr std::size_t kMostLineBytes = 8192;
constexpr std::size_t kNamedFiles = 3;
constexpr std::string_view kExpectedList =
    "expected lines of \"stamp file\", as TUM's rgb.txt has them";
constexpr std::string_view kBetweenWords = " \t\r,;";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(kBetweenWords), text.size());
  const std::size_t end = text.find_last_not_of(kBetweenWords);
  return end == std::string_view::npos ? std::string_view() : text.substr(begin, end - begin + 1);
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

class ListReader {
 public:
  explicit ListReader(const std::string& file)
      : file_(file), folder_(fs::path(file).parent_path()) {}

  Outcome<void> take(std::string_view line, std::size_t number) {
    if (number == 1) line = without_byte_order_mark(line);
    line = trimmed(line);
    if (line.empty() || line.front() == '#' || line.front() == '%') return {};
    const std::size_t end = std::min(line.find_first_of(kBetweenWords), line.size());
    const std::string_view word = line.substr(0, end), rest = trimmed(line.substr(end));
    ListedImage image;
    if (!parse_stamp(word, image.stamp_ns)) {
      double value = 0;
      const bool header = !seen_ && !parse_number(word, value);
      seen_ = true;
      if (header) return {};
      return wrong(number, "\"" + std::string(word.substr(0, 40)) + "\" is not a stamp");
    }
    seen_ = true;
    if (rest.empty()) return wrong(number, "names no file");
    if (!images_.empty() && image.stamp_ns <= images_.back().stamp_ns) {
      return wrong(number, "its stamp " + std::string(word) +
                               " does not rise over the one before; sort the list by stamp");
    }
    if (images_.size() == kMostImages) return wrong(number, "more than 1,000,000 images");
    find(image, rest);
    images_.push_back(std::move(image));
    return {};
  }

  Outcome<std::vector<ListedImage>> end() && {
    if (images_.empty()) return failure(file_ + ": lists no image; " + std::string(kExpectedList));
    if (missing_ == 0) return std::move(images_);
    std::string text = file_ + ": " + counted(missing_, "file") + " of " +
                       std::to_string(images_.size()) + (missing_ == 1 ? " is" : " are") +
                       " missing: " + named_;
    if (missing_ > kNamedFiles) text += " …";
    return failure(text + "; names are relative to the list's folder", ErrorCode::kNotFound);
  }

  Failure wrong(std::size_t number, const std::string& what) const {
    return failure(file_ + ":" + std::to_string(number) + ": " + what + "; " +
                   std::string(kExpectedList));
  }

 private:
  void find(ListedImage& image, std::string_view rest) {
    fs::path path = folder_ / fs::path(std::string(rest));
    if (!is_file(path)) {
      const std::string first(rest.substr(0, rest.find_first_of(" \t")));
      if (const fs::path other = folder_ / first; is_file(other)) {
        path = other;
      } else if (++missing_ <= kNamedFiles) {
        named_ += (named_.empty() ? "" : ", ") + path.string();
      }
    }
    image.file = path.string();
  }

  const std::string file_;
  const fs::path folder_;
  bool seen_ = false;  // a line that is no comment
  std::vector<ListedImage> images_;
  std::size_t missing_ = 0;
  std::string named_;
};

bool is_image_name(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return ending == ".jpg" || ending == ".jpeg" || ending == ".png";
}

}  // namespace

Outcome<std::vector<ListedImage>> read_image_list(const std::string& file) {
  errno = 0;
  std::error_code error;
  if (fs::is_directory(file, error)) {
    return failure(file + ": is a folder; " + std::string(kExpectedList));
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    return failure(file + ": " + std::strerror(errno) + "; " + std::string(kExpectedList),
                   ErrorCode::kNotFound);
  }
  if (const std::string kind = stand_in_at(file); !kind.empty()) {
    return failure(file + ": is " + kind + "; " + std::string(kExpectedList));
  }
  ListReader reader(file);
  // std::getline would take a line of any length.
  std::string line(kMostLineBytes, '\0');
  for (std::size_t number = 1; in.getline(line.data(), kMostLineBytes) || in.gcount() > 0;
       ++number) {
    if (in.fail() && !in.eof()) return reader.wrong(number, "is longer than 8191 bytes");
    const auto length = std::strlen(line.data());
    if (auto taken = reader.take({line.data(), length}, number); !taken) return taken.error();
  }
  if (in.bad()) return failure(file + ": " + std::strerror(errno), ErrorCode::kIo);
  return std::move(reader).end();
}

Outcome<std::vector<ListedImage>> list_image_folder(const std::string& folder) {
  const fs::path list = fs::path(folder) / "rgb.txt";
  if (is_file(list)) return read_image_list(list.string());
  std::error_code error;
  std::vector<ListedImage> images;
  std::size_t others = 0;
  fs::directory_iterator each(folder, error);
  for (; !error && each != fs::directory_iterator(); each.increment(error)) {
    const fs::path& path = each->path();
    if (!is_image_name(path)) continue;
    ListedImage image{0, path.string()};
    if (!parse_stamp(path.stem().string(), image.stamp_ns)) {
      ++others;
      continue;
    }
    if (images.size() == kMostImages) return failure(folder + ": has more than 1,000,000 images");
    images.push_back(std::move(image));
  }
  if (error) return failure(folder + ": " + error.message(), ErrorCode::kNotFound);
  if (images.empty()) {
    return failure(folder + ": has no rgb.txt and no image whose name is a stamp" +
                   (others > 0 ? " (" + counted(others, "image") + " with other names)" : "") +
                   "; expected DIR/rgb.txt or files like 1718021600.500000.jpg");
  }
  std::sort(images.begin(), images.end(), [](const ListedImage& a, const ListedImage& b) {
    return a.stamp_ns != b.stamp_ns ? a.stamp_ns < b.stamp_ns : a.file < b.file;
  });
  for (std::size_t i = 1; i < images.size(); ++i) {
    if (images[i].stamp_ns == images[i - 1].stamp_ns) {
      return failure(images[i].file + ": has the stamp of " + images[i - 1].file +
                     "; expected one image a stamp");
    }
  }
  return images;
}

}  // namespace zonepack::localize
