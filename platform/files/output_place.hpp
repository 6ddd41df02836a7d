// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "platform/base/result.hpp"
#include "platform/files/descriptor.hpp"

namespace zonepack {

// How a regular file that exists already is written: by renaming a new one over it, for which its
// folder must be writable (AtomicFile), or as it stands (AppendFile, open_in_place()).
enum class Overwriting { kByRename, kInPlace };

// Whether a file of this name could be written, found out before there is anything to write; a
// FIFO is not opened, since its reader would take the closing for the end. kIo with errno: EISDIR,
// or why the folder or the file cannot be written. kNotFound: there is no such folder.
Result<void> check_output_place(const std::string& path,
                                Overwriting how = Overwriting::kByRename) noexcept;

// The folder in which a file of this name lies: "." where the path names none.
std::string folder_of_path(const std::string& path);

// Opens a file, a device or a FIFO for writing in place. A FIFO that nobody reads is waited for, up
// to a second. kIo with errno; ENXIO: nobody reads it.
Result<Descriptor> open_in_place(const std::string& path, bool create) noexcept;

}  // namespace zonepack
