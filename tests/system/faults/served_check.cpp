// SPDX-License-Identifier: Apache-2.0
// usage: served_check SOCKET MAP...: reads every zone that zoned serves, in place, again and again,
// through crashes and changes of map, and compares each signature with the packs of the maps. Says
// ready when it begins; ends at SIGTERM with one line of JSON; with 1 when anything was served that
// no pack holds, and 2 when nothing was read at all.
#include <signal.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "runtime/client/client.hpp"
#include "runtime/map/loader.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"
#include "tests/system/readers/zone_images.hpp"

namespace zonepack {
namespace {

constexpr useconds_t kPause_us = 2000;

volatile sig_atomic_t stop = 0;

using Digests = std::map<std::string, std::set<std::uint64_t>>;  // by zone

bool add_map(const std::string& folder, Digests& digests) {
  const auto catalog = Catalog::open(folder, kDefaultPayload);
  if (!catalog) return false;
  for (ZoneId zone = 0; zone < catalog->zones.size(); ++zone) {
    const auto pack = open_pack(*catalog, zone, kDefaultReadMode);
    if (!pack) return false;
    const PayloadMask mask = payload_closure(kDefaultPayload, pack->index().grid_needs_scan());
    const auto decoded = DecodedPack::decode(*pack, mask);
    if (!decoded) return false;
    digests[catalog->zones[zone].name].insert(
        test_support::digest_of(ZoneSignatures(decoded->view())));
  }
  return true;
}

struct Counts {
  std::uint64_t connections = 0, reads = 0, absent = 0, expired = 0, damaged = 0, wrong = 0;
};

// Every zone once; false when zoned is gone.
bool read_all(Client& client, const Digests& digests, Counts& counts) {
  if (const auto pose = client.pose(); !pose && pose.error().code == ErrorCode::kCancelled) {
    return false;
  }
  const auto zones = client.zones();
  if (!zones) return zones.error().code != ErrorCode::kCancelled;
  for (const ZoneInfo& zone : *zones) {
    std::uint64_t digest = 0;
    switch (client.read(zone.zone, [&](const ZoneSignatures& signatures) {
      digest = test_support::digest_of(signatures);
    })) {
      case ReadStatus::kOk: {
        ++counts.reads;
        const auto known = digests.find(zone.name);
        counts.wrong += known == digests.end() || known->second.count(digest) == 0;
        break;
      }
      case ReadStatus::kExpired:
        ++counts.expired;
        break;
      case ReadStatus::kAbsent:
        ++counts.absent;
        break;
      case ReadStatus::kDamaged:
        ++counts.damaged;
        break;
    }
  }
  return true;
}

int run(const std::string& socket, const Digests& digests) {
  Counts counts;
  std::optional<Client> client;
  while (stop == 0) {
    if (!client) {
      if (auto connected = Client::connect(socket, "served_check", 500)) {
        client.emplace(std::move(*connected));
        ++counts.connections;
      }
    }
    if (client && !read_all(*client, digests, counts)) client.reset();
    ::usleep(kPause_us);
  }
  const auto n = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
  std::printf(
      "{\"connections\":%llu,\"reads\":%llu,\"absent\":%llu,\"expired\":%llu,\"damaged\":%llu,"
      "\"wrong\":%llu}\n",
      n(counts.connections), n(counts.reads), n(counts.absent), n(counts.expired),
      n(counts.damaged), n(counts.wrong));
  if (counts.wrong + counts.damaged > 0) return 1;
  return counts.reads > 0 ? 0 : 2;
}

}  // namespace
}  // namespace zonepack

int main(int argc, char** argv) {
  if (argc < 3) return std::fputs("usage: served_check SOCKET MAP...\n", stderr), 2;
  zonepack::Digests digests;
  for (int i = 2; i < argc; ++i) {
    if (zonepack::add_map(argv[i], digests)) continue;
    std::fprintf(stderr, "served_check: %s: cannot be read as a whole map\n", argv[i]);
    return 2;
  }
  ::signal(SIGTERM, [](int) { zonepack::stop = 1; });
  std::fputs("ready\n", stderr);
  return zonepack::run(argv[1], digests);
}
