// SPDX-License-Identifier: Apache-2.0
#include "platform/files/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "platform/files/output_place.hpp"
#include "platform/linux/last_error.hpp"

namespace zonepack {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPartMark = ".part-";

std::string part_name(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  return path + std::string(kPartMark) + std::to_string(::getpid()) + "-" +
         std::to_string(counter.fetch_add(1));
}

// Replacing a device or a pipe with a file would take it away from every program; as root, even
// /dev/null.
bool is_written_in_place(const std::string& path) {
  std::error_code unknown;
  const fs::file_status status = fs::status(path, unknown);
  if (!fs::exists(status)) return false;
  const bool ours = path == "/dev/stdout" || path == "/dev/stderr" || path.starts_with("/dev/fd/");
  return ours || !(fs::is_regular_file(status) || fs::is_directory(status));
}

// The target of a link, so that the link itself stays.
std::string behind_links(std::string path) {
  std::error_code failed;
  if (!fs::is_symlink(path, failed)) return path;
  const fs::path target = fs::canonical(path, failed);
  return failed ? path : target.string();
}

Result<void> sync_folder(const std::string& folder) noexcept {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return last_error();
  const Result<void> done = ::fsync(fd) == 0 ? Result<void>() : Result<void>(last_error());
  ::close(fd);
  return done;
}

std::size_t skip_digits(std::string_view text, std::size_t at) noexcept {
  while (at < text.size() && text[at] >= '0' && text[at] <= '9') ++at;
  return at;
}

}  // namespace

Result<AtomicFile> AtomicFile::create(std::string path) {
  if (is_written_in_place(path)) {
    auto file = open_in_place(path, false);
    if (!file) return file.error();
    return AtomicFile(file->release(), std::move(path), {});
  }
  path = behind_links(std::move(path));
  std::string part = part_name(path);
  const int fd = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0) return last_error();
  return AtomicFile(fd, std::move(path), std::move(part));
}

Result<AtomicFile> AtomicFile::standard_output() {
  const int fd = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
  if (fd < 0) return last_error();
  return AtomicFile(fd, {}, {});
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      path_(std::move(other.path_)),
      part_(std::exchange(other.part_, {})) {}

AtomicFile::~AtomicFile() {
  if (fd_ >= 0) ::close(fd_);
  if (!part_.empty()) ::unlink(part_.c_str());
}

Result<void> AtomicFile::write(std::span<const std::byte> bytes) noexcept {
  ZP_REQUIRE(fd_ >= 0);
  while (!bytes.empty()) {
    const ::ssize_t written = ::write(fd_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return last_error();
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

Result<void> AtomicFile::write(std::string_view text) noexcept {
  return write(std::as_bytes(std::span(text)));
}

Result<void> AtomicFile::commit() { return commit_as(path_); }

Result<void> AtomicFile::commit_as(const std::string& path) {
  ZP_REQUIRE(fd_ >= 0);
  const bool in_place = part_.empty();
  if (!in_place && ::fsync(fd_) != 0) return last_error();
  if (::close(std::exchange(fd_, -1)) != 0) return last_error();
  if (in_place) return {};
  if (std::rename(part_.c_str(), path.c_str()) != 0) return last_error();
  part_.clear();
  return sync_folder(folder_of_path(path));
}

bool is_part_name(std::string_view name) noexcept {
  const std::size_t mark = name.rfind(kPartMark);
  if (mark == std::string_view::npos || mark == 0) return false;
  const std::size_t pid = mark + kPartMark.size();
  const std::size_t dash = skip_digits(name, pid);
  if (dash == pid || dash >= name.size() || name[dash] != '-') return false;
  return dash + 1 < name.size() && skip_digits(name, dash + 1) == name.size();
}

Result<void> write_file_atomically(const std::string& path, std::string_view content) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  if (const Result<void> written = file->write(content); !written) return written;
  return file->commit();
}

}  // namespace zonepack
