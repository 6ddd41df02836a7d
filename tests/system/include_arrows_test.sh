#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: include_arrows_test.sh SOURCE: dependencies point one way, and foreign headers stay behind seams.
set -euo pipefail
cd "$1"
bad=0
forbid() {  # WHAT FILES-BELOW PATTERN [EXCEPT-PATTERN]
  local found
  found=$(grep -rnE "^#include [<\"]($3)" --include='*.hpp' --include='*.cpp' $2 | grep -vE "${4:-^$}" || true)
  if [ -n "$found" ]; then printf '%s:\n%s\n' "$1" "$found"; bad=1; fi
}
forbid "platform must not know what stands on it" platform 'runtime/|packer/|tests/'
forbid "the pack format must not know its users" runtime/pack_format 'runtime/(map|memory|zones|odometry|replay|report|settings|localize|serve)/|packer/|runtime/[a-z_]+\.hpp'
forbid "reports know the pack format only" runtime/report 'runtime/(map|memory|zones|odometry|replay|settings|localize|serve)/|packer/|runtime/[a-z_]+\.hpp'
forbid "the core must not know replay, settings or pictures" "runtime/map runtime/memory runtime/zones runtime/odometry" 'runtime/(replay|report|settings|serve|localize)/|packer/|runtime/[a-z_]+\.hpp'
forbid "a client knows loaded zones, their layout and the protocol only" runtime/client 'runtime/(map|zones|odometry|replay|report|settings|live|localize)/|runtime/memory/(arena|residency|shared_map|zone_)|runtime/pack_format/file/|packer/|runtime/[a-z_]+\.hpp|yaml|sodium|lz4'
forbid "the runtime must not know the packer" runtime 'packer/|sqlite3\.h|opencv|nlohmann'
forbid "packer and runtime share the pack format and the pictures only" packer 'runtime/(map|memory|zones|odometry|replay|settings|localize|serve)/|runtime/[a-z_]+\.hpp'
forbid "system headers stay in platform/linux" "platform/base platform/sim runtime" 'linux/|sys/(mman|socket|epoll|ioctl)\.h|gpiod'
forbid "libgpiod has one file, so that another version needs one more" "platform runtime packer tests" 'gpiod\.h' '^platform/linux/gpiod/gpiod_line\.cpp'
forbid "products do not include tests" "platform runtime packer" 'tests/'
exit $bad
