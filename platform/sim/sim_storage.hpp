// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "platform/files/storage_probe.hpp"

namespace zonepack {

// Makes files fail or stall, and records what is read of them, during its lifetime; only one may
// exist at a time. A file is named by the end of its path.
//
// Threads: any. A read that is held blocks its thread as a dead disk would.
class SimStorage final : public StorageProbe {
 public:
  struct Read {
    std::string path;
    std::uint64_t offset;
    std::uint64_t size;
  };

  SimStorage();
  ~SimStorage() override;
  SimStorage(const SimStorage&) = delete;
  SimStorage& operator=(const SimStorage&) = delete;

  // Makes opening fail with this error.
  void fail_open(const std::string& file, Error error);
  // Makes reads that touch bytes at or after `from` fail with this error.
  void fail_reads(const std::string& file, std::uint64_t from, Error error);
  // Makes reads wait until release().
  void hold_reads(const std::string& file);
  void release();
  // Removes all faults and releases held reads.
  void heal();

  // Whether a read is being held now.
  bool holding() const;
  // All reads of files opened during the lifetime of this object, including failed ones.
  std::vector<Read> reads() const;

  Result<FileMark> on_open(const std::string& path) noexcept override;
  Result<void> on_read(FileMark file, std::uint64_t offset, std::uint64_t size) noexcept override;

 private:
  struct Fault {
    std::string file;
    bool open = false;
    bool hold = false;
    std::uint64_t from = 0;
    Error error;
  };

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Fault> faults_;
  std::vector<std::string> opened_;  // by FileMark - 1
  std::vector<Read> reads_;
  std::uint32_t held_ = 0;
};

}  // namespace zonepack
