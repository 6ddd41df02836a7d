#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: faults.sh BIN SOURCE [KILLS]: whatever happens to files, disk, clock, bus, loader or the process itself, zoned
# lives or starts again into a true state, other zones go on, an event or a message says what happened, and nothing is
# ever served that no pack holds. Needs zonepack, zoned, zonectl, served_check, hold_thread and the unit tests in BIN.
# One row for each fault; exits with 1 when one does not hold. `real` rows are whole programs on real files, `unit` rows
# tests of what this machine cannot be made to do (or does not do often enough).
set -euo pipefail
bin=$1 source=$2 kills=${3:-1000}
data=$source/tests/data
drive=$data/scenario1_loop
work=$(mktemp -d)
chmod 755 "$work"
cd "$work"
export ZONED_SOCKET=$work/run/zoned.sock
pid= reader= mounted=
clean() {
  for process in $pid $reader; do kill -9 "$process" 2>/dev/null || true; done
  [ -z "$mounted" ] || umount "$mounted" || true
  rm -rf "$work"
}
trap clean EXIT

privilege=()
chrt -f 1 true 2>/dev/null || privilege=(--allow-degraded)
failed=0
printf '%-48s %-5s %-62s %s\n' fault how "what was seen" verdict
row() {  # FAULT HOW SEEN VERDICT
  printf '%-48s %-5s %-62s %s\n' "$@"
  [[ $4 == holds || $4 == "not here"* ]] || failed=1
}
why() { reason="$*"; return 1; }
field() { jq -r "$2" "$1" 2>/dev/null || echo 0; }

unit() {  # FAULT PROGRAM FILTER
  local verdict=holds ran
  "$bin/$2" --gtest_brief=1 --gtest_filter="$3" >unit.txt 2>&1 || { verdict="DOES NOT HOLD"; cat unit.txt >&2; }
  ran=$(sed -n 's/^\[==========\] \([0-9]*\) tests\{0,1\} from.*/\1/p' unit.txt | tail -1)
  ((${ran:-0} > 0)) || verdict="NO SUCH TEST"
  row "$1" unit "${ran:-0} tests of $2" "$verdict"
}

build() { "$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" \
  --payload features,scan,grid "$@" >/dev/null 2>&1; }
build --out first
build --out second --max-zone-bytes 300KiB
chmod -R a+rX first second
budget() { "$bin/zonepack" plan "$1" --json - 2>/dev/null | jq .live_change_budget_bytes; }
most=$(($(budget first) > $(budget second) ? $(budget first) : $(budget second)))
version() { "$bin/zonepack" inspect "$1" --json - 2>/dev/null | jq -r .version; }
first=$(version first) second=$(version second)

settings() { sed "$1" "$source/config/agilex.yaml" >robot.yaml; chmod a+r robot.yaml; }
as=() broken=() known=(first second)
start() {  # CAN OPTION...: zoned on a fresh copy of the map, and a reader that checks all it serves
  local can=$1
  shift
  rm -rf map run && cp -r first map && mkdir -m 777 run
  read_along
  "${broken[@]}"
  "${as[@]}" "$bin/zoned" run --config robot.yaml --map map --can "$can" --corrections "$drive/corrections.txt" \
    --budget "$most" --json live.json --events live.jsonl "${privilege[@]}" "$@" >out.txt 2>&1 &
  pid=$!
}
read_along() {
  "$bin/served_check" "$ZONED_SOCKET" "${known[@]}" >read.json 2>ready.txt &
  reader=$!
  for _ in $(seq 300); do ! grep -q ready ready.txt || return 0; sleep 0.1; done
  echo "served_check does not begin: $(cat ready.txt)" >&2
}
status() { "$bin/zonectl" status --json status.json >/dev/null 2>&1; }
until_status() {  # JQ-CONDITION
  for _ in $(seq 1000); do
    status && jq -e "$1" status.json >/dev/null && return 0
    kill -0 "$pid" 2>/dev/null || { why "ended before $1: $(head -2 out.txt | tr '\n' ' ')"; return 1; }
    sleep 0.03
  done
  why "never $1"
}
finish() {  # waits for the end of the drive (or asks for it: finish TERM), and looks at everything
  [ -z "${1:-}" ] || kill -"$1" "$pid"
  wait "$pid" || { pid=; why "exit code: $(head -2 out.txt | tr '\n' ' ')"; return 1; }
  pid=
  kill -TERM $reader
  wait $reader || { reader=; why "read: $(cat read.json)"; return 1; }
  reader=
  jq -e ".budget_violations == 0 and .allocations == 0 and .lost_events == 0" live.json >/dev/null ||
    { why "$(cat live.json)"; return 1; }
}
told() { grep -q -- "$1" out.txt || { why "no word of '$1'"; return 1; }; }
happened() { grep -q "\"event\":\"$1\".*${2:-}" live.jsonl || { why "no event $*"; return 1; }; }
others_loaded() {  # zones but C2
  local loaded
  loaded=$(grep '"event":"load_done"' live.jsonl | grep -vc '"zone":"C2"') || true
  ((loaded > 2)) || { why "only $loaded loads of others"; return 1; }
}
reads() { field read.json .reads; }
verdict() {  # FAULT CODE
  if (($2 == 0)); then row "$1" real "$seen; $(reads) reads" holds; else
    row "$1" real "$reason" "DOES NOT HOLD"
    kill -9 $pid $reader 2>/dev/null || true
    pid= reader=
  fi
}
broken_pack() {  # FAULT SEEN WORD COMMAND...: something happens to the pack of C2, where the robot comes by
  local fault=$1 word=$3
  seen=$2
  shift 3
  local code=0
  broken=("$@")
  start "log:$drive/can0.log@20"
  broken=()
  { finish && told "zone C2 cannot be loaded.*$word" &&
    happened load_failed C2 && others_loaded; } || code=$?
  verdict "$fault" $code
}

# The reader can find fault: one that knows another map only does.
settings '' && known=(second) && code=0
start "log:$drive/can0.log@20"
wait $pid && pid= || code=1
kill -TERM $reader && wait $reader && code=1
known=(first second) reader= seen="$(field read.json .wrong) wrong" reason="the reader finds no fault"
((code != 0)) || [[ $(field read.json .wrong) -gt 0 ]] || code=1
verdict "none: a reader that knows another map only" "$code"

# --- files ---
settings 's/read: [a-z]* /read: mapped /; s/rate_limit: 0 /rate_limit: 40000 /'
cut_while_loading() {
  local zone=
  for _ in $(seq 300); do
    zone=$("$bin/zonectl" zones 2>/dev/null | awk '/filling/ {print $1; exit}')
    [ -z "$zone" ] || { truncate -s 4096 map/"$zone"-*.zpk; echo "$zone" >cut.txt; return 0; }
    sleep 0.02
  done
  why "nothing was ever being loaded"
}
code=0 seen="load_failed by name, others go on"
start "log:$drive/can0.log@1"
{ cut_while_loading && until_status '.loads_given_up > 0' && until_status '.zones_loaded > 0' && finish TERM &&
  told "zone $(cat cut.txt) cannot be loaded" && happened load_failed "$(cat cut.txt)"; } || code=$?
verdict "pack truncated while mapped" $code
unit "pack truncated while mapped: SIGBUS" test_map 'Modes/LoadFaults.Cut*:*LoadFaults.Cut*'
unit "the same, any thread, any moment" test_platform 'GuardedCopy.*'
settings ''
broken_pack "file removed" "load_failed: not found" "not found" rm map/C2-*.zpk
replace() { for pack in map/C2-*.zpk; do cp map/R11-*.zpk map/coming && mv map/coming "$pack"; done; }
broken_pack "file replaced by another zone's" "load_failed: mismatch" "" replace
flip() {  # in the header, the first chunk, the middle, and the tail
  local pack size at
  for pack in map/C2-*.zpk; do
    size=$(stat -c %s "$pack")
    for at in 3 200 $((size / 2)) $((size - 5)); do printf '\xA5' | dd of="$pack" bs=1 seek=$at conv=notrunc status=none; done
  done
}
broken_pack "bits flipped in place" "load_failed by its checksum" "" flip
unit "every bit of every region flipped" test_packer 'ExhaustiveDamage.EveryFlippedBit*:LyingManifests.WithAnyBit*'
unit "every bit of every region flipped, loaded" test_map '*LoaderDamage.AnyFlippedBit*'
unit "removed, replaced, overwritten while loading" test_map '*LoadFaults.Removed*:*LoadFaults.Replaced*:*LoadFaults.Over*'
unit "EIO in the middle of a load" test_map '*LoadFaults.ADiskThatFails*'
if ((EUID == 0)) && setpriv --reuid=65534 --regid=65534 --clear-groups test -r "$work/first/manifest.zpm" -a -x "$bin/zoned"; then
  as=(setpriv --reuid=65534 --regid=65534 --clear-groups)
  privilege=(--allow-degraded)
  touch live.json live.jsonl && chmod 777 "$work"
  broken_pack "permission lost" "load_failed by name" "" chmod 000 map/C2-*.zpk
  as=() privilege=()
  chrt -f 1 true 2>/dev/null || privilege=(--allow-degraded)
else
  unit "permission lost" test_map '*LoadFaults.NotAllowed*'
fi
code=0 seen="the old map stays in use"
"$source/tests/system/map_change_test.sh" "$bin" "$source" >out.txt 2>&1 || { code=1; reason=$(head -1 out.txt); }
echo '{"reads":0}' >read.json
verdict "map half copied, short, damaged" $code

# --- disk full ---
mkdir state
if mount -t tmpfs -o size=64k none state 2>/dev/null; then
  mounted=$work/state
  settings 's/bytes: 67108864 /bytes: 0 /'
  code=0 seen="said once, goes on, saved when there is room"
  dd if=/dev/zero of=state/filler bs=4k status=none 2>/dev/null || true
  STATE_DIRECTORY=$work/state start "log:$drive/can0.log@20"
  { until_status '.zone_switches >= 0 and .map_ready' && sleep 1 && told "state cannot be saved: No space" &&
    rm state/filler && finish && told "state is saved again" && [ -s state/state-0 ]; } || code=$?
  verdict "ENOSPC for state" $code
  umount state && mounted=
else
  unit "ENOSPC for state" test_state 'StateSaverTest.CountsWhatCannotBeSaved*'
fi
rm -rf state
settings ''

# --- clock, bus, loader ---
unit "wall clock stepped" test_platform 'StampConverter.*:HardwareStamps.*'
cat >bus.yaml <<EOF
log: $drive/can0.log
bit_rate: 500000
faults: [{at: 15, for: 3, kind: absent}, {at: 30, for: 2, kind: down}, {at: 45, for: 2, kind: bus_off}]
EOF
code=0 seen="odometry_stale, odometry_resumed, drives on"
start sim:bus.yaml@20
{ finish && told "can0: down" && happened odometry_stale && happened odometry_resumed && others_loaded; } || code=$?
verdict "CAN source lost and back" $code

settings 's/rate_limit: 0 /rate_limit: 150000 /'
code=0 seen="cycles go on, zones are read, loads after it"
start "log:$drive/can0.log@2"
hold() {
  until_status '.zones_filling > 0' || return 1
  local before after loaded
  before=$(field status.json .cycles) loaded=$(field status.json .zones_loaded)
  "$bin/hold_thread" $pid zoned-loader 2 || return $?
  status
  after=$(field status.json .cycles)
  ((after - before > 200)) || { why "only $((after - before)) cycles in 2 s"; return 1; }
  until_status ".zones_loaded > $loaded"
}
{ hold && finish TERM && happened load_done; } || code=$?
if ((code == 77)); then
  kill -9 $pid $reader && pid= reader=
  row "loader stuck in the kernel" real "ptrace is not allowed" "not here"
else
  verdict "loader stuck in the kernel" $code
fi
unit "a load given up while the disk stands still" test_live 'Loading.*Pause*:Loading.*Cancelled*'

# --- killed ---
settings 's/bytes: 67108864 /bytes: 2097152 /'
put() { cp "$1" map/.coming && mv map/.coming "map/$(basename "$1")"; }
rm -rf map run && cp -r first map && cp second/*.zpk map && mkdir run state
export STATE_DIRECTORY=$work/state
read_along
code=0 started=0 changes=0 loads=0 evictions=0 saved=0
RANDOM=1
kill_once() {  # [SECONDS]: lives so much longer; blocks of the flight recorder are a second long
  local expected=$first want=$first
  cmp -s map/manifest.zpm second/manifest.zpm && expected=$second
  "$bin/zoned" run --config robot.yaml --map map --can "log:$drive/can0.log@40" --corrections "$drive/corrections.txt" \
    --budget "$most" "${privilege[@]}" >out.txt 2>&1 &
  pid=$!
  sleep 0.0$((RANDOM % 10))
  if ((RANDOM % 2)) && status; then
    want=$(field status.json .map_version)
    [[ $want == "$expected" ]] || { why "starts with map $want, not $expected"; return 1; }
    jq -e ".charged_bytes <= $most" status.json >/dev/null || { why "over the budget"; return 1; }
    started=$((started + 1))
  fi
  if ((RANDOM % 2)); then
    if [[ $expected == "$first" ]]; then put second/manifest.zpm; else put first/manifest.zpm; fi
    kill -HUP $pid 2>/dev/null || true
  fi
  sleep 0.$((RANDOM % 3))$((RANDOM % 10))
  sleep "${1:-0}"
  if kill -0 $pid 2>/dev/null; then kill -9 $pid; fi
  wait $pid 2>/dev/null || true
  pid=
  ! grep -E "cannot be used|cannot be opened|abort|require" out.txt || { why "$(tail -1 out.txt)"; return 1; }
}
look_back() {  # what the killed run left behind, and that it can be replayed
  [ -e state/flight/preface ] || return 0
  [ ! -e state/state-0 ] || saved=$((saved + 1))
  "$bin/zoned" replay --recording state/flight --events flight.jsonl --json flight.json >flight.txt 2>&1 ||
    grep -q "first cycle" flight.txt || { why "flight: $(tail -1 flight.txt)"; return 1; }
  loads=$((loads + $(grep -c '"event":"load_' flight.jsonl || true)))
  evictions=$((evictions + $(grep -c '"event":"evicted"' flight.jsonl || true)))
  changes=$((changes + $(grep -c '"event":"map_changed"' flight.jsonl || true)))
}
for ((i = 1; i <= kills; i++)); do
  if ((i % 10 != 0)); then
    kill_once || { code=1; break; }
  else
    kill_once 1.$((RANDOM % 10)) && look_back || { code=1; break; }
  fi
done
if ((code == 0)); then
  kill -TERM $reader
  wait $reader || { code=1; why "read: $(cat read.json)" || true; }
  reader=
fi
((code != 0 || started > kills / 10)) || { code=1; why "only $started of $kills starts were seen" || true; }
((code != 0 || (loads > 0 && evictions > 0 && changes > 0 && saved > 0))) ||
  { code=1; why "loads $loads evictions $evictions changes $changes saved $saved" || true; }
seen="$started starts asked, all into a true state"
verdict "killed $kills times" $code
row "  what they were doing, every tenth" real "$loads loads, $evictions evictions, $changes changes of map" holds
if ((code == 0)); then
  seen="no violation, packs whole"
  read_along
  "$bin/zoned" run --config robot.yaml --map map --can "log:$drive/can0.log@50" --corrections "$drive/corrections.txt" \
    --budget "$most" --json live.json --events live.jsonl "${privilege[@]}" >out.txt 2>&1 &
  pid=$!
  { finish && others_loaded && "$bin/zonepack" verify map >verify.txt 2>&1; } || code=1
  verdict "  and a whole drive after the last" $code
fi
((failed == 0)) || { echo "a fault does more than it may"; exit 1; }
echo "every fault costs what it must and no more"
