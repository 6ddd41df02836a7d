// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/options.hpp"

#include <algorithm>
#include <cstddef>
#include <iostream>
#include <stdexcept>

#include "packer/console/output_path.hpp"
#include "packer/console/words.hpp"
#include "platform/base/failure.hpp"
#include "platform/files/atomic_file.hpp"

namespace zonepack::packer {
namespace {

PayloadMask parse_payload(const std::string& text) {
  PayloadMask mask = kCoreOnly;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    bool known = false;
    for (std::uint32_t k = 1; k < kPayloadKinds; ++k) {
      const auto kind = static_cast<fb::PayloadKind>(k);
      if (word != zonepack::to_string(kind)) continue;
      mask |= mask_of(kind);
      known = true;
    }
    if (!known) {
      throw CLI::ValidationError("'" + word + "' is no payload; choose from " +
                                 payload_text(kEveryPayload));
    }
    begin = end + 1;
  }
  return mask;
}

}  // namespace

CLI::Option* add_size_option(CLI::App& app, const std::string& name, ByteCount& target,
                             const std::string& help) {
  return app
      .add_option_function<std::string>(
          name,
          [&target, name](const std::string& text) {
            const auto size = parse_byte_count(text);
            if (!size) {
              throw CLI::ValidationError(name, "'" + text +
                                                   "' is no SIZE; give bytes, or a number with a "
                                                   "unit, such as 8MiB, 6.8MiB, 8M or 50MB");
            }
            target = *size;
          },
          help)
      ->type_name("SIZE");
}

CLI::Option* add_payload_option(CLI::App& app, const std::string& name, PayloadMask& target,
                                const std::string& help) {
  return app
      .add_option_function<std::string>(
          name, [&target](const std::string& text) { target = parse_payload(text); }, help)
      ->type_name("LIST");
}

void JsonOutput::add_option(CLI::App& app) {
  app.add_option("--json", file_, "write the result as JSON to FILE ('-': standard output)")
      ->type_name("FILE");
}

std::ostream& JsonOutput::text() const { return file_ == "-" ? std::cerr : std::cout; }

void JsonOutput::require_writable() const { packer::require_writable(file_); }

void JsonOutput::write(const nlohmann::ordered_json& json) const {
  if (file_.empty()) return;
  const std::string text =
      json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  if (file_ == "-") {
    std::cout << text << std::flush;
    if (!std::cout) throw std::runtime_error("cannot write JSON to standard output");
    return;
  }
  if (const Result<void> written = write_file_atomically(file_, text); !written) {
    throw std::runtime_error(cannot_write(file_, written.error()).message);
  }
}

}  // namespace zonepack::packer
