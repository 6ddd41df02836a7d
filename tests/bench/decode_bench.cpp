// SPDX-License-Identifier: Apache-2.0
// Loading a map's zones from a warm page cache: the runtime's loader (ZoneLoad::step: read, XXH3,
// LZ4, every check) against the same work written plainly (pread in pieces of the same length,
// XXH3, LZ4_decompress_safe), against LZ4_decompress_safe alone, over the same chunks into the same
// slots, and against memcpy of what is decoded. They take turns on every zone; time is the thread's
// own, so that other programs do not count. Opening a pack and reading its index is reported
// separately; both readers begin with a pack just opened, because the first bytes read through a
// new file cost more than the next.
//
//   decode_bench MAP [ROUNDS [DECODED]]: all zones' decoded bytes are written to the file DECODED
#include <lz4.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/map/loader.hpp"
#include "tests/bench/bench_map.hpp"

namespace zonepack {
namespace {

using bench::BenchMap;
using bench::fail;

double now_s() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

// What the plain versions need of a chunk, laid out before the clock starts.
struct PlainChunk {
  std::uint64_t offset, xxh3;
  std::uint32_t stored, decoded;
  bool lz4;
  std::byte* out;
  const std::byte* in_memory;  // its stored bytes
};

struct Zone {
  ZoneId id = 0;
  std::string path;
  std::vector<PlainChunk> chunks;
  std::vector<std::byte> stored;
  std::uint64_t decoded = 0;
};

void unpack(const PlainChunk& chunk, const std::byte* stored) {
  if (!chunk.lz4) {
    std::memcpy(chunk.out, stored, chunk.stored);
    return;
  }
  const int size =
      LZ4_decompress_safe(reinterpret_cast<const char*>(stored), reinterpret_cast<char*>(chunk.out),
                          static_cast<int>(chunk.stored), static_cast<int>(chunk.decoded));
  if (size != static_cast<int>(chunk.decoded)) fail("a chunk does not decode");
}

double time_lz4(const Zone& zone) {
  const double begin = now_s();
  for (const PlainChunk& chunk : zone.chunks) unpack(chunk, chunk.in_memory);
  return now_s() - begin;
}

double time_copy(const Zone& zone, std::span<std::byte> into) {
  const double begin = now_s();
  for (const PlainChunk& chunk : zone.chunks) {
    std::memcpy(into.data(), chunk.out, chunk.decoded);
    asm volatile("" : : "r"(into.data()) : "memory");
  }
  return now_s() - begin;
}

double time_plain(const Catalog& catalog, const Zone& zone, std::span<std::byte> buffer) {
  const Result<PackReader> pack = open_pack(catalog, zone.id);
  if (!pack) fail(zone.path + ": " + to_string(pack.error().code));
  const double begin = now_s();
  for (std::size_t first = 0; first < zone.chunks.size();) {
    const std::uint64_t from = zone.chunks[first].offset;
    std::size_t last = first;
    std::uint64_t to = from + zone.chunks[first].stored;
    while (last + 1 < zone.chunks.size() && zone.chunks[last + 1].offset == to &&
           to + zone.chunks[last + 1].stored - from <= buffer.size()) {
      to += zone.chunks[++last].stored;
    }
    if (!pack->file().read_at(from, buffer.first(to - from))) fail("a pack cannot be read");
    for (; first <= last; ++first) {
      const PlainChunk& chunk = zone.chunks[first];
      const std::byte* const stored = buffer.data() + (chunk.offset - from);
      if (xxh3({stored, chunk.stored}) != chunk.xxh3) fail("a chunk has another checksum");
      unpack(chunk, stored);
    }
  }
  return now_s() - begin;
}

struct Loader {
  double open_s = 0, load_s = 0;
};

Loader time_loader(const Catalog& catalog, const Zone& zone, std::span<std::byte* const> slots,
                   std::span<std::byte> buffer) {
  Loader times;
  const double begin = now_s();
  Result<ZoneLoad> load = ZoneLoad::begin(catalog, zone.id, slots, buffer, ReadMode::kCached);
  if (!load) fail(zone.path + ": " + to_string(load.error().code));
  const double opened = now_s();
  for (;;) {
    const Result<bool> more = load->step();
    if (!more) fail(zone.path + ": " + to_string(more.error().code));
    if (!*more) break;
  }
  times.load_s = now_s() - opened;
  times.open_s = opened - begin;
  return times;
}

Zone prepare(const Catalog& catalog, ZoneId id, std::span<std::byte* const> slots) {
  Zone zone;
  zone.id = id;
  zone.path = catalog.folder + "/" + catalog.zones[id].pack;
  const Result<PackReader> pack = open_pack(catalog, id);
  if (!pack) fail(zone.path + ": " + to_string(pack.error().code));
  zone.stored.resize(pack->tail().index_offset);
  if (!pack->file().read_at(0, zone.stored)) fail(zone.path + ": cannot be read");
  const PayloadMask mask = payload_closure(catalog.payload, pack->index().grid_needs_scan());
  Placement placement;
  for (const fb::ChunkEntry* entry : *pack->index().chunks()) {
    if ((mask & mask_of(entry->kind())) == 0) continue;
    const Placement::Place place = placement.add(entry->decoded_size());
    zone.chunks.push_back({entry->offset(), entry->xxh3(), entry->stored_size(),
                           entry->decoded_size(), entry->codec() == fb::ChunkCodec::Lz4,
                           slots[place.slot] + place.offset, zone.stored.data() + entry->offset()});
    zone.decoded += entry->decoded_size();
  }
  return zone;
}

double percentile(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(p * static_cast<double>(values.size() - 1) + 0.5)];
}

std::string hardware() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "an unknown processor";
}

void measure(const std::string& folder, const std::string& name, PayloadMask payload, int rounds) {
  const BenchMap map(folder, payload);
  std::vector<std::byte> buffer(kReadBufferBytes), copied(kSlotBytes);
  std::vector<Zone> zones;
  std::uint64_t decoded = 0;
  for (ZoneId id = 0; id < map.catalog.zones.size(); ++id) {
    zones.push_back(prepare(map.catalog, id, map.slots));
    decoded += zones.back().decoded;
  }
  std::vector<double> over_plain, over_lz4;
  double copy_s = 0, lz4_s = 0, plain_s = 0, loader_s = 0, open_s = 0;
  for (int round = -1; round < rounds; ++round) {
    double copy = 0, lz4 = 0, plain = 0, loader = 0, opening = 0;
    for (std::size_t i = 0; i < zones.size(); ++i) {
      for (int turn = 0; turn < 3; ++turn) copy += time_copy(zones[i], copied);
      for (int turn = 0; turn < 9; ++turn) {  // each goes first, second and third
        switch ((turn + turn / 3) % 3) {
          case 0:
            lz4 += time_lz4(zones[i]);
            break;
          case 1:
            plain += time_plain(map.catalog, zones[i], buffer);
            break;
          default: {
            const Loader times = time_loader(map.catalog, zones[i], map.slots, buffer);
            loader += times.load_s;
            opening += times.open_s;
          }
        }
      }
    }
    if (round < 0) continue;  // warms caches
    over_plain.push_back(loader / plain);
    over_lz4.push_back(loader / lz4);
    copy_s += copy;
    lz4_s += lz4;
    plain_s += plain;
    loader_s += loader;
    open_s += opening;
  }
  const double mb = static_cast<double>(decoded) * 3 * rounds / 1e6;
  std::printf("%-9s %9.1f %7.0f %7.0f %7.0f %7.0f   %6.3f %6.3f %6.3f   ", name.c_str(),
              static_cast<double>(decoded) / 1e6, mb / copy_s, mb / lz4_s, mb / plain_s,
              mb / loader_s, plain_s / loader_s, lz4_s / loader_s, open_s / loader_s);
  for (const double p : {0.5, 0.99, 0.999, 1.0}) std::printf(" %6.3f", percentile(over_plain, p));
  std::printf("  ");
  for (const double p : {0.5, 0.99, 0.999, 1.0}) std::printf(" %6.3f", percentile(over_lz4, p));
  std::printf("\n");
}

void write_decoded(const std::string& folder, const std::string& path) {
  const BenchMap map(folder, kDefaultPayload);
  std::ofstream out(path, std::ios::binary);
  for (ZoneId id = 0; id < map.catalog.zones.size(); ++id) {
    const Zone zone = prepare(map.catalog, id, map.slots);
    time_lz4(zone);
    for (const PlainChunk& chunk : zone.chunks) {
      out.write(reinterpret_cast<const char*>(chunk.out), chunk.decoded);
    }
  }
  if (!out.flush()) fail(path + ": cannot be written");
}

void run(const std::string& folder, int rounds) {
  const Result<std::vector<std::byte>> file =
      read_file(folder + "/" + std::string(kManifestName), kMaxManifestBytes);
  if (!file) fail(folder + ": no map: " + to_string(file.error().code));
  const Result<const fb::Manifest*> manifest = check_manifest(*file);
  if (!manifest) fail(folder + ": " + to_string(manifest.error().code));
  std::printf("%s, %d rounds over all zones, each kind with its core; MB/s of decoded bytes\n\n",
              hardware().c_str(), rounds);
  std::printf(
      "                              MB/s                  loader's speed over     open   "
      "time over plain               time over LZ4\n");
  std::printf(
      "loaded           MB  memcpy     LZ4   plain  loader    plain    LZ4         "
      "    p50    p99  p99.9    max      p50    p99  p99.9    max\n");
  for (std::uint32_t k = 0; k < kPayloadKinds; ++k) {
    const auto kind = static_cast<fb::PayloadKind>(k);
    const auto holds_some = [&](const fb::Zone* zone) {
      return std::any_of(zone->payloads()->begin(), zone->payloads()->end(),
                         [&](const fb::PayloadBytes* bytes) { return bytes->kind() == k; });
    };
    const auto& all = *(*manifest)->zones();
    if (std::none_of(all.begin(), all.end(), holds_some)) continue;
    measure(folder, to_string(kind), kCoreOnly | mask_of(kind), rounds);
  }
  measure(folder, "default", kDefaultPayload, rounds);
}

}  // namespace
}  // namespace zonepack

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: decode_bench MAP [ROUNDS [DECODED]]\n";
    return 2;
  }
  try {
    zonepack::run(argv[1], argc > 2 ? std::max(1, std::atoi(argv[2])) : 1000);
    if (argc > 3) zonepack::write_decoded(argv[1], argv[3]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
