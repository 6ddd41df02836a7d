// SPDX-License-Identifier: Apache-2.0
// Decodes frames with a DBC file, for comparison with another reader: decode_dbc FILE.
// Standard input: "message hexadecimal-data" a line. For each it prints "Message.Signal value" of
// every signal that is there, values with 17 digits.
#include <cstdio>
#include <iostream>
#include <string>

#include "runtime/settings/dbc_file.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const zonepack::LoadedDbc loaded = zonepack::load_dbc(argv[1]);
  for (const std::string& fault : loaded.faults) std::fprintf(stderr, "%s\n", fault.c_str());
  if (!loaded.ok()) return 1;
  std::string name, data;
  while (std::cin >> name >> data) {
    zonepack::CanFrame frame;
    for (std::size_t i = 0; i + 1 < data.size() && frame.len < 64; i += 2) {
      frame.data[frame.len++] =
          static_cast<std::uint8_t>(std::stoul(data.substr(i, 2), nullptr, 16));
    }
    for (const zonepack::DbcMessage& message : loaded.file.messages()) {
      if (message.name != name) continue;
      frame.id = message.id;
      frame.extended = message.extended;
      for (const zonepack::DbcSignal& signal : message.signals) {
        const std::string full = name + "." + signal.name;
        const auto found = loaded.file.find(full);
        if (!found) {
          std::fprintf(stderr, "%s\n", found.error().message.c_str());
          return 1;
        }
        const auto reading = zonepack::read_signal(found->signal, frame);
        if (reading.status == zonepack::SignalReading::Status::kValue) {
          std::printf("%s %.17g\n", full.c_str(), reading.value);
        }
      }
    }
  }
  return 0;
}
