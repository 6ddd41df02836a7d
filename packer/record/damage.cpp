// SPDX-License-Identifier: Apache-2.0
#include "packer/record/damage.hpp"

#include <utility>

namespace zonepack::packer {
namespace {

std::string message(const std::string& file, const Damage& damage) {
  return file + ": signature " + std::to_string(damage.signature) +
         " is damaged: " + damage.column + ": " + damage.problem;
}

}  // namespace

DamagedSignature::DamagedSignature(const std::string& file, Damage damage)
    : std::runtime_error(message(file, damage)), damage_(std::move(damage)) {}

void CellPlace::damaged(const std::string& problem) const {
  if (signature == 0) throw std::runtime_error(*file + ": " + column + ": " + problem);
  throw DamagedSignature(*file, Damage{signature, column, problem});
}

}  // namespace zonepack::packer
