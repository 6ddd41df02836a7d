// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/recording_file.hpp"

#include <utility>
#include <vector>

#include "runtime/recording/block.hpp"

namespace zonepack {

Result<std::unique_ptr<RecordingFile>> RecordingFile::create(const std::string& path,
                                                             const RecordingPreface& preface) {
  Result<AppendFile> file = AppendFile::create(path);
  if (!file) return file.error();
  std::unique_ptr<RecordingFile> recording(new RecordingFile(std::move(file).value()));
  recording->append(recording_header());
  write_preface(preface, [&](ByteSpan block) { recording->append(block); });
  if (recording->error_.code != ErrorCode::kOk) return recording->error_;
  return recording;
}

void RecordingFile::append(ByteSpan block) noexcept {
  if (error_.code != ErrorCode::kOk) return;
  error_ = file_.append(block).error();
}

Result<void> RecordingFile::finish(const RecordingEnd& end) {
  std::vector<std::byte> block;
  seal_block(BlockKind::kEnd, write_end(end), block);
  append(block);
  if (error_.code == ErrorCode::kOk) error_ = file_.sync().error();
  return error_;
}

}  // namespace zonepack
