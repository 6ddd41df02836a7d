# SPDX-License-Identifier: Apache-2.0
# Sourced by the proofs of this folder: missions that are driven again and again, and memory cgroups of either version.

fail() { echo "$(basename "$0" .sh): $*" >&2; exit 1; }

# Seconds from the first to the last frame of a log.
log_seconds() {  # MISSION
  awk -F'[()]' 'NF > 1 { if (!first) first = $2; last = $2 } END { printf "%.6f", last - first }' "$1/can0.log"
}

# A mission driven LOOPS times without a pause, localizer and all: PATH.yaml for --can sim: and PATH.txt for
# --corrections. MISSION: a folder with can0.log and corrections.txt.
repeat_mission() {  # MISSION LOOPS PATH
  printf 'log: %s/can0.log\nloops: %s\nbit_rate: 0\nqueue: 0\n' "$(realpath "$1")" "$2" >"$3.yaml"
  awk -v loops="$2" -v turn="$(log_seconds "$1")" '
    /^#/ || NF < 8 { next }
    { stamp[++n] = $1; received[n] = $2; $1 = $2 = ""; rest[n] = $0 }
    END {
      for (loop = 0; loop < loops; ++loop)
        for (i = 1; i <= n; ++i) {
          shift = loop * (turn + 0.02)
          printf "%.6f %.6f %s\n", stamp[i] + shift, received[i] + shift, rest[i]
        }
    }' "$1/corrections.txt" >"$3.txt"
}

# Where memory is limited here: sets cgroup_base and names of files. False where it cannot be.
# shellcheck disable=SC2034  # for those who source this
find_memory_cgroups() {
  local v1=/sys/fs/cgroup/memory v2=/sys/fs/cgroup
  if [ -f $v1/memory.limit_in_bytes ]; then
    cgroup_base=$v1 limit_file=memory.limit_in_bytes peak_file=memory.max_usage_in_bytes
  elif grep -qw memory $v2/cgroup.controllers 2>/dev/null; then
    cgroup_base=$v2 limit_file=memory.max peak_file=memory.peak
  else
    return 1
  fi
}

make_group() {  # PATH LIMIT
  mkdir "$1" 2>/dev/null || return 1
  if [ "$limit_file" = memory.max ]; then
    echo +memory >"$(dirname "$1")/cgroup.subtree_control" 2>/dev/null || true
    if [ -f "$1/memory.swap.max" ]; then echo 0 >"$1/memory.swap.max"; fi
  fi
  echo "$2" >"$1/$limit_file"
}

limit_hits() {  # GROUP: how often its own limit was hit
  if [ "$limit_file" = memory.max ]; then
    awk '$1 == "max" { print $2 }' "$1/memory.events.local"
  else
    cat "$1/memory.failcnt"
  fi
}

remove_group() {  # GROUP, once its processes are gone
  for _ in $(seq 100); do
    [ -d "$1" ] && ! rmdir "$1" 2>/dev/null || return 0
    sleep 0.05
  done
}

drop_caches() {
  sync
  if [ -w /proc/sys/vm/drop_caches ]; then echo 3 >/proc/sys/vm/drop_caches; fi
}

# Outside of any group, before a drive: the kernel charges a file's pages to who reads them first, and far more of them
# than a program maps, which is what counts as its own.
read_libraries() {  # PROGRAM...
  ldd "$@" | awk '$3 ~ /^\// { print $3 }' | sort -u | xargs cat >/dev/null
}

mib() { awk -v n="$1" 'BEGIN { printf "%.2f", n / 1048576 }'; }  # BYTES

# The same drive under less and less, until it fails: a proof that cannot fail shows nothing. Uses $work and fail;
# DRIVE NAME LIMIT writes $work/NAME/code and $work/NAME/hits.
drive_until_it_fails() {  # PEAK STEP TURNS DRIVE...
  local lower=$1 step=$2 turns=$3 turn code hits
  shift 3
  for turn in $(seq "$turns"); do
    lower=$((lower - step))
    "$@" "lower-$turn" $lower
    code=$(cat "$work/lower-$turn/code") hits=$(cat "$work/lower-$turn/hits")
    if ((code != 0 || hits > 0)); then
      echo "fails under $lower bytes, $(mib $lower) MiB: exit code $code, limit hit $hits times"
      return
    fi
  done
  fail "the drive does not fail under $lower bytes either, so this proves nothing"
}
