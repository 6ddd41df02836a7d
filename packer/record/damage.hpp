// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace zonepack::packer {

// What is wrong inside one signature of a source database.
struct Damage {
  std::int32_t signature = 0;
  std::string column;   // "Data.scan"
  std::string problem;  // "expected 76 bytes (19 float32), found 40"
};

// One signature cannot be read; every other one can. The message is complete: it names the file,
// the signature, the column and what was expected.
class DamagedSignature : public std::runtime_error {
 public:
  DamagedSignature(const std::string& file, Damage damage);
  const Damage& damage() const noexcept { return damage_; }

 private:
  Damage damage_;
};

// Where a value is stored, for the messages of its parsers. Cheap to copy.
//
// Ownership: refers to `file`.
struct CellPlace {
  const std::string* file = nullptr;
  std::int32_t signature = 0;  // 0: not inside a signature (Admin, Info)
  const char* column = "";

  CellPlace at(const char* other_column) const noexcept { return {file, signature, other_column}; }

  // Throws DamagedSignature, or std::runtime_error where no signature is to blame.
  [[noreturn]] void damaged(const std::string& problem) const;
};

}  // namespace zonepack::packer
