// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "platform/base/result.hpp"
#include "platform/files/append_file.hpp"
#include "runtime/recording/bytes.hpp"
#include "runtime/recording/preface.hpp"
#include "runtime/recording/recording_end.hpp"

namespace zonepack {

// A recording as it is written: every block as soon as it is there, so that a crash at any moment
// leaves a recording of all blocks before it.
//
// After an error nothing more is written: the file remains a valid beginning.
//
// Threads: one; not for the control thread.
class RecordingFile {
 public:
  // Writes header and preface. kIo with errno.
  static Result<std::unique_ptr<RecordingFile>> create(const std::string& path,
                                                       const RecordingPreface& preface);

  void append(ByteSpan block) noexcept;

  // Ends the recording and makes it durable; or the first error there was.
  Result<void> finish(const RecordingEnd& end);

  // The first error, if there was one.
  Error error() const noexcept { return error_; }
  std::uint64_t size() const noexcept { return file_.size(); }

 private:
  explicit RecordingFile(AppendFile file) : file_(std::move(file)) {}
  AppendFile file_;
  Error error_;
};

}  // namespace zonepack
