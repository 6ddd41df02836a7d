// SPDX-License-Identifier: Apache-2.0
// A heavy neighbour of the map, as a language model is: reads a file of weights over and over, half
// of it on either core, and now and then takes memory for a moment, as for a prompt. Run by
// tenant.sh, together with zoned and zoneloc.
//
//   tenant FILE SECONDS BURST_BYTES read|mmap
//
// Prints a line a second until SECONDS are over or SIGTERM comes: bytes of FILE that went through
// the cores meanwhile, and bursts of memory taken. Each byte is added up, so none is left out.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::size_t kBlock = 256 * 1024;
constexpr std::size_t kPage = 4096;
constexpr auto kBurstEvery = milliseconds(500), kBurstHeld = milliseconds(150);

std::atomic<bool> ending{false};
std::atomic<std::uint64_t> streamed{0}, sum{0};

std::uint64_t added_up(const unsigned char* block, std::size_t size) {
  std::uint64_t total = 0;
  for (std::size_t at = 0; at + 8 <= size; at += 8) {
    std::uint64_t word;
    std::memcpy(&word, block + at, 8);
    total += word;
  }
  return total;
}

// The file as the streams see it: mapped, or null where it is read.
struct Weights {
  int file = -1;
  std::size_t size = 0;
  const unsigned char* mapped = nullptr;
};

// Bytes from `begin` to `end`, again and again.
void stream(const Weights& weights, std::size_t begin, std::size_t end) {
  std::vector<unsigned char> buffer(weights.mapped ? 0 : kBlock);
  for (std::size_t at = begin; !ending;) {
    const std::size_t size = std::min(kBlock, end - at);
    const unsigned char* block = buffer.data();
    if (weights.mapped) {
      block = weights.mapped + at;
    } else if (pread(weights.file, buffer.data(), size, static_cast<off_t>(at)) !=
               static_cast<ssize_t>(size)) {
      std::perror("tenant: the file of weights cannot be read");
      std::_Exit(1);
    }
    sum += added_up(block, size);
    streamed += size;
    at = at + size < end ? at + size : begin;
  }
}

// Takes memory, uses every page of it, and gives it back.
void take_for_a_moment(std::size_t bytes) {
  void* const taken =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (taken == MAP_FAILED) return;
  for (std::size_t at = 0; at < bytes; at += kPage) static_cast<volatile char*>(taken)[at] = 1;
  std::this_thread::sleep_for(kBurstHeld);
  munmap(taken, bytes);
}

Weights open_weights(const char* path, bool map) {
  Weights weights;
  struct stat found {};
  weights.file = open(path, O_RDONLY | O_CLOEXEC);
  if (weights.file < 0 || fstat(weights.file, &found) != 0) {
    std::fprintf(stderr, "tenant: %s: %s\n", path, std::strerror(errno));
    std::exit(1);
  }
  weights.size = static_cast<std::size_t>(found.st_size);
  if (weights.size < 2 * kBlock) {
    std::fprintf(stderr, "tenant: %s: at least %zu bytes are expected\n", path, 2 * kBlock);
    std::exit(1);
  }
  if (!map) return weights;
  void* const at = mmap(nullptr, weights.size, PROT_READ, MAP_SHARED, weights.file, 0);
  if (at == MAP_FAILED) std::perror("tenant: mmap"), std::exit(1);
  weights.mapped = static_cast<const unsigned char*>(at);
  return weights;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string way = argc == 5 ? argv[4] : "";
  if (way != "read" && way != "mmap") {
    return std::fprintf(stderr, "usage: tenant FILE SECONDS BURST_BYTES read|mmap\n"), 2;
  }
  const Weights weights = open_weights(argv[1], way == "mmap");
  const auto seconds = std::chrono::duration<double>(std::atof(argv[2]));
  const auto burst_bytes = static_cast<std::size_t>(std::strtoull(argv[3], nullptr, 10));
  std::signal(SIGTERM, [](int) { ending = true; });

  const std::size_t middle = weights.size / 2 / kBlock * kBlock;
  std::thread one(stream, std::cref(weights), 0, middle);
  std::thread other(stream, std::cref(weights), middle, weights.size);
  const auto begun = Clock::now();
  auto next_burst = begun, next_line = begun + milliseconds(1000);
  unsigned bursts = 0;
  while (!ending) {
    if (burst_bytes > 0 && Clock::now() >= next_burst) {
      take_for_a_moment(burst_bytes);
      ++bursts;
      next_burst += kBurstEvery;
    }
    const auto now = Clock::now();
    if (now >= next_line || now - begun >= seconds) {
      std::printf("%llu %u\n", static_cast<unsigned long long>(streamed.exchange(0)), bursts);
      std::fflush(stdout);
      bursts = 0;
      next_line += milliseconds(1000);
    }
    if (now - begun >= seconds) ending = true;
    std::this_thread::sleep_for(milliseconds(5));
  }
  one.join();
  other.join();
  return sum == 0 ? 1 : 0;  // the sum is used, so that the additions are made
}
