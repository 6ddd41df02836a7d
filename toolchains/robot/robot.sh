# SPDX-License-Identifier: Apache-2.0
# Sourced by toolchains/run: the virtual robot, a QEMU machine with Debian's kernel and our package.

# Run there, on lines, buses and cameras of a kernel.
device_programs=(gpio_line_contract can_bus_contract can_frames video_device_contract hold_thread)

set_flavour() {  # arm64|armhf|rt-arm64: sets arch, flavour (Debian's name of the kernel)
  case $1 in
    arm64 | rt-arm64) flavour=$1; use_arch arm64 ;;
    armhf) flavour=armmp; use_arch armhf ;;
    *) echo "unknown robot '$1': expected arm64, armhf or rt-arm64" >&2; return 2 ;;
  esac
}

# The guest with our package, and build/robot/FLAVOUR/payload: tests, sample map and run, the host's decisions.
make_guest() {
  local out=build/robot/$flavour
  local payload=$out/payload data=tests/data/scenario1_loop
  stage "robot: kernel and guest, $flavour"
  toolchains/robot/kernel.sh "$flavour"
  rm -rf "$payload"
  mkdir -p "$payload/tests" "$payload/data"
  toolchains/robot/guest.sh "$flavour" build/"$arch"/zonepack-{runtime,localizer}_*.deb
  cp tests/system/guest/*.sh "$payload/tests/"
  cp -r tests/data/scenario1_loop "$payload/data/"
  mkdir "$payload/bin"
  cp "${device_programs[@]/#/build/$arch/bin/}" "$payload/bin/"
  local host=build/test/bin
  build_map() {  # FOLDER PAYLOAD
    "$host/zonepack" build --db tests/data/hospital-small.db --zones tests/data/zones.geojson --out "$payload/$1" \
      --payload "$2" >/dev/null 2>&1
  }
  build_map map features,scan,grid
  build_map map2 features,scan  # another version of it
  "$host/zonepack" plan "$payload/map" --json - 2>/dev/null | jq .smallest_budget_bytes >"$payload/budget"
  echo "${ZONEPACK_RUNS:-10}" >"$payload/runs"
  "$host/zoned" replay --config config/agilex.yaml --map "$payload/map" --can $data/can0.log \
    --corrections $data/corrections.txt --truth $data/base_groundtruth.txt --max-signatures 50 \
    --events "$payload/events.jsonl" >/dev/null
  # The first half minute of the drive with its camera: what both ends localize.
  mkdir "$payload/loop"
  awk '/^\(/ { split($1, t, /[()]/); if (t[2] < 1718021630) print }' $data/can0.log >"$payload/loop/can0.log"
  awk '$1 < 1718021630' $data/rgb.txt >"$payload/loop/rgb.txt"
  cp $data/base_groundtruth.txt $data/calibration.yaml "$payload/loop/"
  rm -rf "$payload/data/scenario1_loop/rgb"
  mkdir "$payload/loop/rgb"
  awk '!/^#/ { print $2 }' "$payload/loop/rgb.txt" | while read -r image; do cp "$data/$image" "$payload/loop/$image"; done
  tests/system/guest/closed_loop.sh "$host/zoneloc" config/agilex.yaml "$payload" "$payload/loop" >/dev/null
}

options_of() { sed -n 's/^# boot: //p' "tests/system/guest/$1.sh"; }  # TEST

hindrance_of() { sed -n "s/^# not on $flavour: //p" "tests/system/guest/$1.sh"; }  # TEST: why this kernel cannot run it

guest_tests() {  # [BOOT-OPTIONS]: names of all tests, or of those with these options
  local test
  for test in tests/system/guest/*_test.sh; do
    test=$(basename "$test" .sh)
    if (($# == 0)) || [ "$(options_of "$test")" = "$1" ]; then echo "$test"; fi
  done
}

# Each test once, those with the same boot options together; prints a line for each. Recordings made there are in
# build/robot/FLAVOUR/recordings.
run_guest_tests() {  # [TEST...], all by default
  local out=build/robot/$flavour boot failed=0 test why
  local -a asked=("$@") tests=()
  ((${#asked[@]})) || mapfile -t asked < <(guest_tests)
  for test in "${asked[@]}"; do
    why=$(hindrance_of "$test")
    if [ -n "$why" ]; then echo "not run: $test: $why"; else tests+=("$test"); fi
  done
  rm -rf "$out/recordings"
  mkdir -p "$out/recordings"
  while read -r boot; do
    for test in "${tests[@]}"; do
      if [ "$(options_of "$test")" = "$boot" ]; then echo "$test"; fi
    done >"$out/payload/group"
    cp tests/system/guest/start "$out/payload/start"
    local console=$out/console-${boot// /-}.log status=0
    # shellcheck disable=SC2086
    CONSOLE=$console OUT=$out/recordings toolchains/robot/boot.sh "$flavour" "$out/payload" $boot </dev/null >/dev/null || status=$?
    tr -d '\r' <"$console" | sed -n '/^    /p; s/^TEST //p'
    local ran
    ran=$(grep -c '^TEST ' "$console" || true)
    if ((status != 0)) || grep -q '^TEST FAILED' "$console"; then failed=1; fi
    if ((ran != $(wc -l <"$out/payload/group"))); then
      echo "the guest ended early (status $status); the end of $console:"
      tail -20 "$console"
      failed=1
    fi
  done < <(for test in "${tests[@]}"; do options_of "$test" | grep . || echo; done | sort -u)
  return $failed
}

prepare_robot() {  # arm64|armhf|rt-arm64
  set_flavour "$1" || exit 2
  ready
  build test --target zonepack zoned zoneloc
  cross_build "$arch" zoned zonectl zoneloc "${device_programs[@]}"
  toolchains/deb/packages.sh "build/$arch" "$arch" "$sysroot" robot
  make_guest
}

do_system() {  # [arm64|armhf|rt-arm64 [TEST...]]
  prepare_robot "${1:-arm64}"
  stage "system tests: on the virtual robot, $flavour"
  run_guest_tests "${@:2}"
  if (($# < 2)) || [[ " ${*:2} " == *" drive_test "* ]]; then replay_recordings "$arch"; fi
}

# What was recorded on the robot, replayed by the host's zoned and, under qemu-user, by those of ARCH.
replay_recordings() {  # ARCH...
  local -a zoneds=(build/test/bin/zoned)
  local other
  for other in "$@"; do zoneds+=("$(emulated "$other" zoned)"); done
  stage "recordings: made on the virtual robot, replayed by ${zoneds[*]}, with and without FMA"
  tests/system/recordings_replayed_test.sh "build/robot/$flavour/recordings" "${zoneds[@]}"
}

do_robot() {  # [arm64|armhf|rt-arm64]
  prepare_robot "${1:-arm64}"
  cp toolchains/robot/shell.sh "build/robot/$flavour/payload/start"
  stage "robot: switching on"
  TIMEOUT=none toolchains/robot/boot.sh "$flavour" "build/robot/$flavour/payload"
}
