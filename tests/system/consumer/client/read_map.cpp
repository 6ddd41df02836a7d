// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <zonepack/client.hpp>

int main(int argc, char** argv) {
  if (argc != 3) return 2;  // read_map SOCKET ZONE
  auto client = zonepack::Client::connect(argv[1], "read_map");
  if (!client) return std::printf("no zoned at %s\n", argv[1]), 1;
  const auto zone = client->find_zone(argv[2]);
  if (!zone) return std::printf("no zone %s\n", argv[2]), 1;
  std::size_t features = 0;
  const auto status = client->read(*zone, [&](const zonepack::ZoneSignatures& all) {
    for (std::uint32_t i = 0; i < all.size(); ++i) features += all[i].features().size();
  });
  std::printf("%s: %zu features\n", to_string(status), features);  // a number only when it is "ok"
}
