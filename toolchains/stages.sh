# SPDX-License-Identifier: Apache-2.0
# Sourced by toolchains/run: the stages of `test --all`. `toolchains/run stage NAME` runs one alone; each builds what it
# needs, and exits with 77 where this machine cannot run it.
stages=(tests lint asan tsan prove deb arm64 robot decisions armhf)

stage_tests() {
  do_install packages-test.txt || stage "not run: the reports' pages in Chromium, which cannot be installed here"
  build test
  ctest_of test "everything, Release, warnings are errors"
}

stage_lint() {
  build test --target zonepack zoned zonectl
  lint
}

# Every test program and every program that a test starts.
stage_asan() {
  build asan
  ctest_of asan "everything again, address and undefined-behaviour sanitizers"
}

# What threads share: queues, arena, loader, sockets.
stage_tsan() {
  local units=(platform memory client serve live)
  build tsan --target "${units[@]/#/test_}"
  ctest_of tsan "threads, thread sanitizer" -R "^($(IFS='|' && echo "${units[*]}"))\$"
}

stage_prove() {
  do_install packages-prove.txt || exit 77
  do_prove --quick
}

stage_deb() { do_deb; }

# What the stages robot and decisions run.
stage_arm64() {
  do_install packages-cross.txt || exit 77
  build test --target zonepack
  cross_build arm64 installed
  stage "tests: the same zones from x86-64 and arm64"
  tests/system/same_zones_test.sh tests/data build/test/bin/zonepack "$(emulated arm64 zonepack)"
  make_packages build/arm64 arm64 "$sysroot"
  stage "not run: unit tests on arm64: toolchains/run cross arm64"
}

# The unit tests of what a robot runs, where an address has 32 bits; char is unsigned on both.
stage_armhf() {
  local units
  mapfile -t units < <(echo platform && ls tests/unit/runtime)
  do_install packages-cross.txt || exit 77
  do_cross armhf "${units[@]}"
  stage "not run: unit tests of the packer on armhf: toolchains/run cross armhf"
}

# One boot of the virtual robot. All tests on all its kernels are `toolchains/run system`.
stage_robot() {
  local there=(drive_test bus_faults_test check_test localizer_test)
  do_install packages-cross.txt || exit 77
  prepare_robot arm64
  stage "system tests: on the virtual robot, $flavour"
  run_guest_tests "${there[@]}"
  cross_build armhf zoned
  set_flavour arm64
  replay_recordings arm64 armhf
  stage "not run: $(guest_tests | grep -vxF "$(printf '%s\n' "${there[@]}")" | tr '\n' ' ')of the virtual robot, armhf and" \
    "PREEMPT_RT: toolchains/run system arm64, armhf, rt-arm64"
}

# g++ and clang as released, clang sanitized at -O1, and both cross compilers.
stage_decisions() {
  build test --target zonepack zoned
  build asan --target zoned
  build clang --target zoned
  local zoneds=(build/test/bin/zoned build/asan/bin/zoned build/clang/bin/zoned) other
  if do_install packages-cross.txt; then
    for other in arm64 armhf; do
      cross_build "$other" zoned
      zoneds+=("$(emulated "$other" zoned)")
    done
  else
    stage "not run: the decisions of arm64 and armhf; their compilers and QEMU cannot be installed here"
  fi
  stage "tests: the same decisions from ${zoneds[*]}, with and without FMA"
  tests/system/same_decisions_test.sh build/test/bin/zonepack tests/data "${zoneds[@]}"
}

# Where ZONEPACK_MINUTES is set, the stages take no longer: none begins in the last 18 of them, and one that still
# runs at the end is stopped and has failed. Who is stopped from outside has shown nothing.
seconds_left() { echo $((ZONEPACK_MINUTES * 60 - SECONDS)); }
late() { [ -n "${ZONEPACK_MINUTES:-}" ] && (($(seconds_left) < 18 * 60)); }
run_stage() {  # NAME
  local limit=()
  if [ -n "${ZONEPACK_MINUTES:-}" ]; then limit=(timeout --kill-after=20 "$(seconds_left)"); fi
  ZONEPACK_SECONDS=$SECONDS "${limit[@]}" toolchains/run stage "$1"
}

# Each in a process of its own, all of them whatever fails, and a table of their times.
run_stages() {  # NAME...
  local name began code result table=() bad=() left=()
  for name in "$@"; do
    began=$SECONDS code=0
    if late; then code=78; else run_stage "$name" || code=$?; fi
    case $code in
      0) result=passed ;;
      77) result="not run: this machine cannot" left+=("$name") ;;
      78) result="not run: less than 18 of $ZONEPACK_MINUTES minutes were left" left+=("$name") ;;
      124 | 137) result="FAILED: stopped after $ZONEPACK_MINUTES minutes" bad+=("$name") ;;
      *) result=FAILED bad+=("$name") ;;
    esac
    table+=("$(printf '%-10s %3d:%02d  %s' "$name" $(((SECONDS - began) / 60)) $(((SECONDS - began) % 60)) "$result")")
    if [[ $result == FAILED* ]]; then stage "$name failed; alone: toolchains/run stage $name"; fi
  done
  stage "stages, minutes and seconds of each"
  printf '   %s\n' "${table[@]}"
  if ((${#bad[@]})); then stage "failed: ${bad[*]}"; return 1; fi
  if ((${#left[@]})); then stage "passed, but for what was not run: ${left[*]}"; else stage "all tests passed"; fi
}

do_stage() {  # NAME
  [[ " ${stages[*]} " == *" ${1:-} "* ]] || { echo "unknown stage '${1:-}': expected one of ${stages[*]}" >&2; exit 2; }
  SECONDS=${ZONEPACK_SECONDS:-0}
  ready
  stage "stage $1"
  "stage_$1"
}

do_test() {  # [--all]
  case ${1:-} in
    --all) run_stages "${stages[@]}" ;;
    '')
      run_stages tests
      what_else
      ;;
    *) usage >&2; exit 2 ;;
  esac
}

what_else() {
  cat <<EOT
There is more than these tests:
   toolchains/run test --all       every stage, 70 minutes: ${stages[*]}
   toolchains/run stage NAME       one of them
   toolchains/run prove            every claim of tests/README.md, an hour
   toolchains/run cross arm64      packages for a robot, and its unit tests under qemu-user; or armhf
   toolchains/run system arm64     all tests on the virtual robot, which has CAN and GPIO; or armhf, rt-arm64
   ZONEPACK_HOSPITAL_DB=map.db toolchains/run test
                                   the round trip of a database of your own too
EOT
}

ctest_of() {  # PRESET WHAT [arguments of ctest]
  stage "tests: $2"
  # One test more than processors, since a third of their time is waiting. The limit is for tests that name none: what a
  # failed one left running may hold its output open for good.
  ctest --preset "$1" -j "$(($(nproc) + 1))" --timeout 600 --output-on-failure "${@:3}" 2>&1 | counted "build/$1/ctest.log"
  skipped "$1"
}

# Each reason for which GoogleTest left tests out, as they gave it, from the log of ctest.
skipped() {  # PRESET
  awk '/^NOT TESTED: / { why = substr($0, 13) }
    /: Skipped$/ { getline; if ($0 != "" && !why) why = $0 }
    /^\[  SKIPPED \] .*\(/ { if (!count[why]++) first[why] = $4; why = "" }
    END { for (why in count) printf "not run: %s, %d of its kind: %s\n", first[why], count[why], why }' \
    "build/$1/Testing/Temporary/LastTest.log"
}

# Copies the output of ninja or ctest into LOG and shows how far it is: a count that runs on a terminal, a line at every
# tenth elsewhere, and what it waits for when there was no line for two minutes. Of the other lines those are shown that
# do not begin a test or list one as skipped.
counted() {  # LOG
  local line begun='' over='' tenth=0 code
  local -A running=()
  if [ -t 1 ]; then over=$'\r\e[K'; fi
  : >"$1"
  while true; do
    code=0
    IFS= read -r -t 120 line || code=$?
    line=$begun$line begun=
    if ((code > 128)); then
      begun=$line
      if ((${#running[@]})); then printf '%s   waiting for %s\n' "$over" "${running[*]}"; fi
      continue
    fi
    if ((code)) && [ -z "$line" ]; then break; fi
    printf '%s\n' "$line" >>"$1"
    if [[ $line =~ ^\ *Start\ +([0-9]+):\ (.*) ]]; then
      running[${BASH_REMATCH[1]}]=${BASH_REMATCH[2]}
      continue
    fi
    if [[ $line =~ \ Test\ +#([0-9]+): ]]; then unset "running[${BASH_REMATCH[1]}]"; fi
    if [[ ! $line =~ \*\*\*(Failed|Timeout|Exception) && $line =~ ^\ *\[?([0-9]+)/([0-9]+)\]?\  ]]; then
      if [ -n "$over" ]; then
        printf '%s   %s of %s' "$over" "${BASH_REMATCH[@]:1:2}"
      elif ((BASH_REMATCH[1] * 10 / BASH_REMATCH[2] > tenth)); then
        tenth=$((BASH_REMATCH[1] * 10 / BASH_REMATCH[2]))
        printf '   %s of %s\n' "${BASH_REMATCH[@]:1:2}"
      fi
    elif [[ -n $line && $line != *'(Skipped)' ]]; then
      printf '%s%s\n' "$over" "$line"
    fi
  done
  if [ -n "$over" ]; then echo; fi
}
