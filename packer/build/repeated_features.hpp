// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "packer/record/record.hpp"

namespace zonepack::packer {

// Notices signatures whose features are the same, bit for bit. Two images never give that; in a
// damaged database it means that pages of one signature stand where those of another were, which
// SQLite itself cannot see.
//
// Memory: some 100 bytes a signature.
// Threads: any.
class RepeatedFeatures {
 public:
  // Fewer features than this may be alike by chance, as in a test pattern.
  static constexpr std::size_t kLeast = 16;

  void add(const SignatureRecord& record);
  void clear();

  // "signatures 4 and 9 hold the same 312 features", and how many more such groups there are;
  // nothing when there are none. The same for any order of add().
  std::optional<std::string> text() const;

 private:
  // By the number of features and a hash of their bytes.
  std::map<std::pair<std::size_t, std::uint64_t>, std::vector<std::int32_t>> by_content_;
  mutable std::mutex mutex_;
};

}  // namespace zonepack::packer
