// SPDX-License-Identifier: Apache-2.0
#include "platform/memory/account.hpp"

#include <grp.h>
#include <unistd.h>

#include <cerrno>
#include <vector>

namespace zonepack {

bool is_superuser() noexcept { return ::geteuid() == 0; }

Result<std::uint32_t> group_number(const std::string& name) {
  constexpr std::size_t kMost = std::size_t{1} << 20;  // of a group with very many members
  for (std::vector<char> space(1024); space.size() <= kMost; space.resize(space.size() * 4)) {
    group entry{};
    group* found = nullptr;
    const int error = ::getgrnam_r(name.c_str(), &entry, space.data(), space.size(), &found);
    if (error == ERANGE) continue;
    if (found != nullptr) return static_cast<std::uint32_t>(entry.gr_gid);
    // Besides 0, what the manual names for a group that does not exist.
    const bool none = error == 0 || error == ENOENT || error == ESRCH;
    return none ? Error{ErrorCode::kNotFound, error} : Error{ErrorCode::kIo, error};
  }
  return {ErrorCode::kIo, ERANGE};
}

}  // namespace zonepack
