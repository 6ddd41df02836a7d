// SPDX-License-Identifier: Apache-2.0
#include "platform/linux/video_calls.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace zonepack {
namespace {

class KernelCalls final : public VideoCalls {
 public:
  int open(const char* path) noexcept override {
    return ::open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
  }
  bool is_device(int fd) noexcept override {
    struct stat status;
    return ::fstat(fd, &status) == 0 && S_ISCHR(status.st_mode);
  }
  int control(int fd, unsigned long request, void* argument) noexcept override {
    int result = 0;
    do {
      result = ::ioctl(fd, request, argument);
    } while (result < 0 && errno == EINTR);
    return result;
  }
  void* map(int fd, std::size_t bytes, std::int64_t offset) noexcept override {
    void* const at =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, static_cast<off_t>(offset));
    return at == MAP_FAILED ? nullptr : at;
  }
  void unmap(void* at, std::size_t bytes) noexcept override { ::munmap(at, bytes); }
  int wait(int fd, int timeout_ms) noexcept override {
    pollfd one{fd, POLLIN, 0};
    const int ready = ::poll(&one, 1, timeout_ms);
    return ready < 0 && errno == EINTR ? 0 : ready;
  }
  void close(int fd) noexcept override { ::close(fd); }
};

}  // namespace

Outcome<std::unique_ptr<VideoDevice>> VideoDevice::open(const VideoSettings& settings) {
  static KernelCalls calls;
  return open_video(settings, calls);
}

}  // namespace zonepack
