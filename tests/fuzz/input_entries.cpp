// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/input_entries.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "packer/encode/packable.hpp"
#include "packer/sources/cloud/cloud_source.hpp"
#include "packer/sources/cloud/tiled_cloud.hpp"
#include "packer/sources/nvblox/nvblox_source.hpp"
#include "packer/sources/rtabmap/rtabmap_database.hpp"
#include "packer/sources/stella/stella_msgpack.hpp"
#include "packer/sources/stella/stella_source.hpp"
#include "packer/zones/zone_file.hpp"
#include "runtime/protocol/messages.hpp"
#include "runtime/recording/block.hpp"
#include "runtime/recording/recording_reader.hpp"
#include "runtime/settings/settings.hpp"
#include "tests/support/memory_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::fuzz {
namespace {

volatile std::uint64_t consumed;

std::string_view text_of(ByteSpan bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The bytes as a file, whose place is the same for every input.
std::string as_file(const std::vector<std::byte>& bytes, const char* name) {
  static const test_support::TemporaryFolder folder;
  const auto path = folder / name;
  test_support::write_bytes(path, bytes);
  return path.string();
}

// Every string and list that the message refers to, read to its end.
class Reading {
 public:
  void operator()(const flatbuffers::String* text) {
    for (const char c : view_of(text)) sum_ += static_cast<unsigned char>(c);
  }
  template <typename T>
  void operator()(const flatbuffers::Vector<T>* list) {
    if (list == nullptr) return;
    sum_ += list->size();
    const std::size_t bytes = list->size() * sizeof(T);
    for (std::size_t i = 0; i < bytes; ++i) sum_ += list->Data()[i];
  }
  std::uint64_t sum() const { return sum_; }

 private:
  std::uint64_t sum_ = 0;
};

std::uint64_t read_request(const wire::Request& request) {
  Reading read;
  if (const auto* body = request.body_as_Hello()) read(body->client());
  if (const auto* body = request.body_as_AskZone()) read(body->name());
  if (const auto* body = request.body_as_Pin()) read(body->name());
  if (const auto* body = request.body_as_RouteHint()) read(body->zones());
  if (const auto* body = request.body_as_AskRoute()) {
    read(body->from_name());
    read(body->to_name());
  }
  return read.sum() + request.id() + request.map_serial();
}

// Opens the bytes as a map, and reads every signature. Whatever is wrong is said about the file, or
// about one signature.
template <typename Open>
bool read_source(ByteSpan bytes, const char* name, Open open) {
  const std::string path = as_file({bytes.begin(), bytes.end()}, name);
  bool whole = true;
  try {
    const std::unique_ptr<packer::MapSource> source = open(path);
    packer::SignatureRecord record;
    whole = source->outline().damages.empty();
    for (const packer::NodeOutline& node : source->outline().nodes) {
      try {
        source->read(node.id, packer::PayloadSet(), record);
        whole = whole && !packer::find_unpackable(record);
      } catch (const packer::DamagedSignature& error) {
        if (error.damage().signature != node.id) std::abort();
        whole = false;
      }
    }
  } catch (const std::runtime_error& error) {
    if (!std::string_view(error.what()).starts_with(path)) std::abort();
    return false;
  }
  return whole;
}

}  // namespace

bool read_geojson(ByteSpan bytes) {
  const packer::ZoneFile file = packer::parse_zone_file(text_of(bytes), packer::kDefaultSnap_m);
  for (const packer::Finding& fault : file.findings.faults) {
    if (fault.message.empty()) std::abort();
  }
  if (file.findings.faults.size() > 1'000'000) std::abort();
  return file.findings.faults.empty();
}

bool read_settings(ByteSpan bytes) {
  const LoadedSettings loaded = parse_settings(std::string(text_of(bytes)), "a.yaml");
  for (const std::string& fault : loaded.faults) {
    if (fault.empty()) std::abort();
  }
  return loaded.ok();
}

bool read_sqlite(ByteSpan bytes) {
  return read_source(bytes, "map.db", [](const std::string& path) {
    return std::make_unique<packer::RtabmapDatabase>(path);
  });
}

bool read_msgpack(ByteSpan bytes) {
  return read_source(bytes, "map.msg", [](const std::string& path) {
    return std::make_unique<packer::StellaSource>(packer::open_stella_msgpack(path),
                                                  packer::SourceOptions(path));
  });
}

bool read_pcd(ByteSpan bytes) {
  return read_source(bytes, "cloud.pcd", [](const std::string& path) {
    return std::make_unique<packer::CloudSource>(
        "pcd", packer::open_tiled_cloud(packer::SourceOptions(path)), path);
  });
}

bool read_nvblox(ByteSpan bytes) {
  return read_source(bytes, "map.nvblx", [](const std::string& path) {
    return std::make_unique<packer::NvbloxSource>(packer::SourceOptions(path));
  });
}

bool read_recording(ByteSpan bytes) {
  std::vector<std::byte> file = recording_header();
  std::vector<std::byte> sealed;
  while (bytes.size() > 5) {
    const auto kind = static_cast<BlockKind>(bytes[0]);
    std::uint32_t size = 0;
    std::memcpy(&size, &bytes[1], sizeof size);
    bytes = bytes.subspan(5);
    const std::size_t taken = std::min<std::size_t>({size, bytes.size(), kMostBlockBytes});
    if (taken == 0) continue;
    seal_block(kind, bytes.first(taken), sealed);
    file.insert(file.end(), sealed.begin(), sealed.end());
    bytes = bytes.subspan(taken);
  }
  const std::string path = as_file(file, "made_up.zpr");
  auto reader = RecordingReader::open(path);
  if (!reader) {
    if (reader.error().message.empty()) std::abort();
    return false;
  }
  std::uint64_t next = reader->first_cycle();
  while (const RecordedInput* const input = reader->next()) {
    consumed = static_cast<std::uint64_t>(input->now_ns);
    if (reader->cycles_read() != ++next) std::abort();  // cycles follow each other
  }
  return reader->complete();
}

bool read_message(ByteSpan bytes) {
  if (bytes.empty()) return false;
  const bool request = bytes[0] == std::byte{0};
  bytes = bytes.subspan(1);
  std::vector<std::uint64_t> words(bytes.size() / 8 + 1);
  const auto message = std::as_writable_bytes(std::span(words)).first(bytes.size());
  if (!bytes.empty()) std::memcpy(message.data(), bytes.data(), bytes.size());
  if (request) {
    const auto checked = check_request(message);
    if (checked) consumed = read_request(**checked);
    return checked.ok();
  }
  const auto checked = check_reply(message);
  if (checked) consumed = (*checked)->id();
  return checked.ok();
}

}  // namespace zonepack::fuzz
