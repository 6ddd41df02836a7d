// SPDX-License-Identifier: Apache-2.0
#include "platform/sim/sim_storage.hpp"

#include <algorithm>

namespace zonepack {

SimStorage::SimStorage() { set_storage_probe(this); }

SimStorage::~SimStorage() {
  heal();
  set_storage_probe(nullptr);
}

void SimStorage::fail_open(const std::string& file, Error error) {
  const std::lock_guard lock(mutex_);
  faults_.push_back({file, true, false, 0, error});
}

void SimStorage::fail_reads(const std::string& file, std::uint64_t from, Error error) {
  const std::lock_guard lock(mutex_);
  faults_.push_back({file, false, false, from, error});
}

void SimStorage::hold_reads(const std::string& file) {
  const std::lock_guard lock(mutex_);
  faults_.push_back({file, false, true, 0, {}});
}

void SimStorage::release() {
  const std::lock_guard lock(mutex_);
  std::erase_if(faults_, [](const Fault& fault) { return fault.hold; });
  changed_.notify_all();
}

void SimStorage::heal() {
  const std::lock_guard lock(mutex_);
  faults_.clear();
  changed_.notify_all();
}

bool SimStorage::holding() const {
  const std::lock_guard lock(mutex_);
  return held_ > 0;
}

std::vector<SimStorage::Read> SimStorage::reads() const {
  const std::lock_guard lock(mutex_);
  return reads_;
}

Result<StorageProbe::FileMark> SimStorage::on_open(const std::string& path) noexcept {
  const std::lock_guard lock(mutex_);
  for (const Fault& fault : faults_) {
    if (fault.open && path.ends_with(fault.file)) return fault.error;
  }
  opened_.push_back(path);
  return static_cast<FileMark>(opened_.size());
}

Result<void> SimStorage::on_read(FileMark file, std::uint64_t offset, std::uint64_t size) noexcept {
  std::unique_lock lock(mutex_);
  const std::string path = opened_[file - 1];
  reads_.push_back({path, offset, size});
  const auto held = [&] {
    return std::any_of(faults_.begin(), faults_.end(), [&](const Fault& fault) {
      return fault.hold && path.ends_with(fault.file);
    });
  };
  if (held()) {
    ++held_;
    changed_.wait(lock, [&] { return !held(); });
    --held_;
  }
  for (const Fault& fault : faults_) {
    if (!fault.open && !fault.hold && path.ends_with(fault.file) && offset + size > fault.from) {
      return fault.error;
    }
  }
  return {};
}

}  // namespace zonepack
