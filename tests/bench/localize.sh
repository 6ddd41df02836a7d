#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: localize.sh [--quick] BIN DATA [WORK]: the localizer's table: what RTAB-Map does, the target, what was measured.
#
# BIN holds zonepack, zoneloc and localize_queries, built with optimisation (cmake --preset release); the rows of a lost
# robot need localize_lost too, and are left out without it. DATA holds hospital.db, hospital-small.db, zones.geojson,
# scenario1_loop and scenario2_roundtrip with their images. Progress goes to standard error, the table to standard
# output. The rows of memory need zoned too and a memory cgroup, and are left out without. --quick takes every fifth
# image and 200 false priors: four minutes, for a first look. Whole, it takes about twenty.
# The acceptance test was fitted to these two missions, so their rows are no proof for another; the stand-ins use the
# same images too, spoilt by a seed of their own. Times are thread CPU: measure on a machine that does nothing else.
# Exit code: 0 all targets met, 1 some missed or something failed, 2 usage.
set -euo pipefail
quick=
if [ "${1:-}" = --quick ]; then
  quick=1
  shift
fi
if [ $# -lt 2 ] || [ $# -gt 3 ]; then
  sed -n 's/^# \(usage:.*\)/\1/p' "$0" >&2
  exit 2
fi
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
for folder in "$1" "$2"; do
  [ -d "$folder" ] || { echo "localize.sh: $folder is no folder" >&2; exit 1; }
done
bin=$(realpath "$1") data=$(realpath "$2")
for program in zonepack zoneloc localize_queries; do
  [ -x "$bin/$program" ] ||
    { echo "localize.sh: $bin/$program is missing: cmake --build --preset release --target $program" >&2; exit 1; }
done
work=${3:-$(mktemp -d)}
mkdir -p "$work"
[ -n "${3:-}" ] || trap 'rm -rf "$work"' EXIT
every=1 trials=1000
[ -z "$quick" ] || every=5 trials=200
s1=scenario1_loop s2=scenario2_roundtrip
missed=0 rows=()

progress() { echo "[$(date +%T)] $*" >&2; }
# queries NAME MAP MISSION OPTION...: writes $work/NAME.json
queries() {
  progress "$1"
  "$bin/localize_queries" "$work/$2" "$data/$3" every=$every json="$work/$1.json" "${@:4}" >"$work/$1.txt"
}
value() { jq -r "$2" "$work/$1.json"; }
# row WHAT RTABMAP TARGET MEASURED CONDITION...: the conditions are jq's, over numbers.
row() {
  local what=$1 theirs=$2 target=$3 measured=$4 mark=
  shift 4
  for condition in "$@"; do
    [ "$(jq -n "$condition")" = true ] || mark=MISSED
  done
  [ -z "$mark" ] || missed=$((missed + 1))
  rows+=("$(printf '%-52s | %-15s | %-22s | %s %s' "$what" "$theirs" "$target" "$measured" "$mark")")
}
two() { printf '%.3f' "$1"; }

for map in hospital hospital-small; do
  [ -e "$work/$map/manifest.zpm" ] && continue
  progress "pack $map"
  "$bin/zonepack" build --db "$data/$map.db" --zones "$data/zones.geojson" --out "$work/$map" --payload features \
    >"$work/$map.log"
done

# The closed loop, in the plan's smallest budget.
for map in hospital hospital-small; do
  "$bin/zonepack" plan "$work/$map" --json "$work/$map.plan" >/dev/null
  budget=$(jq .smallest_budget_bytes "$work/$map.plan")
  for mission in $s1 $s2; do
    progress "closed loop, $map $mission, $budget bytes"
    run=$data/$mission
    "$bin/zoneloc" replay --config "$root/config/agilex.yaml" --map "$work/$map" --can "$run/can0.log" \
      --images "$run/rgb.txt" --calibration "$run/calibration.yaml" --truth "$run/base_groundtruth.txt" --start truth \
      --budget "$budget" --json "$work/loop.$map.$mission.json" >"$work/loop.$map.$mission.txt"
  done
done
loop_rows() { # MAP MISSION RTABMAP TARGET
  local file=loop.$1.$2 share p95 most yaw wrong_zone
  share=$(value "$file" .right/.images)
  row "right fixes, closed loop, $1 ${2%%_*}" "$3" ">= $4" "$(two "$share")" "$share >= $4"
  row "  accepted fixes that are wrong" "8 in one run" 0 "$(value "$file" .wrong)" "$(value "$file" .wrong) == 0"
  p95=$(value "$file" '.pose_error_m.p95*100') most=$(value "$file" '.pose_error_m.max*100')
  yaw=$(value "$file" .yaw_error_deg.p95)
  row "  pose, every cycle: p95, most; yaw p95" "9 cm to 10 m" "<= 8, 15 cm; 1 deg" \
    "$(printf '%.1f, %.1f cm; %.2f deg' "$p95" "$most" "$yaw")" "$p95 <= 8" "$most <= 15" "$yaw <= 1"
  wrong_zone=$(value "$file" .wrong_zone_s)
  row "  wrong zone; budget violations" - "<= 0.5 %; 0" "$wrong_zone s; $(value "$file" .budget_violations)" \
    "$wrong_zone <= 0.005 * $(value "$file" .images) / 2" "$(value "$file" .budget_violations) == 0"
}
loop_rows hospital $s1 .67 0.95
loop_rows hospital $s2 .55 0.94
loop_rows hospital-small $s1 .23 0.92
loop_rows hospital-small $s2 .16 0.61

# Known prior (0.3 m, 5 degrees), every zone resident.
prior_rows() { # MAP MISSION TARGET P50_CM P95_CM
  local name=prior.$1.${2%%_*} right p50 p95
  queries "$name" "$1" "$2" false=$trials
  right=$(value "$name" .right) p50=$(value "$name" .map_p50_cm) p95=$(value "$name" .map_p95_cm)
  row "right fixes, known prior, $1 ${2%%_*}" - ">= $3, 0 wrong" "$(two "$right"), $(value "$name" .wrong) wrong" \
    "$right >= $3" "$(value "$name" .wrong) == 0"
  row "  fix error in the map's frame p50, p95" - "<= $4, $5 cm" "$(printf '%.2f, %.2f cm' "$p50" "$p95")" \
    "$p50 <= $4" "$p95 <= $5"
  row "    by the nearest one, wherever it looks" - "(to compare)" \
    "$(printf '%.2f, %.2f cm' "$(value "$name" .any_way_p50_cm)" "$(value "$name" .any_way_p95_cm)")"
  row "  false priors accepted, of $trials" - "<= 1" "$(value "$name" .false_accepted)" \
    "$(value "$name" .false_accepted) <= 1"
  row "  query p95; without the detector" "82 to 1515 ms" "<= 20; 8 ms" \
    "$(printf '%.1f; %.1f ms' "$(value "$name" .query_p95_ms)" "$(value "$name" .rest_p95_ms)")" \
    "$(value "$name" .query_p95_ms) <= 20" "$(value "$name" .rest_p95_ms) <= 8"
}
prior_rows hospital $s1 0.95 0.5 3
prior_rows hospital $s2 0.94 0.5 3
prior_rows hospital-small $s1 0.92 1.5 9
prior_rows hospital-small $s2 0.61 1.5 9

# Stand-ins for what is not in DATA: furniture moved, mount half a degree off, exposure between a half and twice.
for mission in $s1 $s2; do
  for map in hospital hospital-small; do
    name=unseen.$map.${mission%%_*}
    queries "$name" "$map" "$mission" change=boxes:0.15+drift pitch=0.5 seed=7
    target=0.83
    [ $map = hospital ] || target=0.57
    right=$(value "$name" .right)
    row "furniture, mount, exposure; $map ${mission%%_*}" - ">= $target, 0 wrong" \
      "$(two "$right"), $(value "$name" .wrong) wrong" "$right >= $target" "$(value "$name" .wrong) == 0"
  done
done

tilt_wrong=0 tilt_least=1
for tilt in roll=1 roll=-1 pitch=1 pitch=-1; do
  for mission in $s1 $s2; do
    name=tilt.$tilt.${mission%%_*}
    queries "$name" hospital "$mission" "$tilt"
    tilt_wrong=$((tilt_wrong + $(value "$name" .wrong)))
    tilt_least=$(jq -n "[$tilt_least, $(value "$name" .right)] | min")
  done
done
row "camera tilted by 1 degree, hospital, worst of 8" - ">= 0.90, <= 1 wrong" "$(two "$tilt_least"), $tilt_wrong wrong" \
  "$tilt_least >= 0.9" "$tilt_wrong <= 1"

# Images spoilt: share of right fixes and the least that a prototype reached where undisturbed images gave 0.92. Both
# maps are held to it.
while read -r change least; do
  for map in hospital hospital-small; do
    name=change.$map.$change
    queries "$name" "$map" "$s1" change="$change"
    right=$(value "$name" .right) wrong=$(value "$name" .wrong)
    row "$change, $map s1" - ">= $least, 0 wrong" "$(two "$right"), $wrong wrong" "$right >= $least" "$wrong == 0"
  done
done <<'TABLE'
gain:0.25 0.92
gain:1.5 0.92
gain:2.5 0.88
gamma:2 0.88
blur:3 0.82
motion:9 0.83
motion:21 0.62
noise:10 0.91
jpeg:30 0.92
cover:0.3 0.86
cover:0.6 0.62
flip 0
fill:0 0
fill:255 0
TABLE

# A lost robot. Both missions end with a robot that stands still, and no rule that wants it to move finds it there: the
# second row counts only starts after which it moves. Then the signatures of one map as the views of a robot in the
# other, which pass through every zone; and those of the large map with what they see cut out of it.
if [ -x "$bin/localize_lost" ]; then
  lost() { # NAME MAP MISSION [OPTION...]: writes $work/NAME.json
    progress "$1"
    "$bin/localize_lost" "$work/$2" "$data/$3" "$root/config/agilex.yaml" every=$every json="$work/$1.json" "${@:4}" \
      >"$work/$1.txt"
  }
  lost_rows() { # MAP FEW FEW_TARGET MANY MANY_TARGET
    local name mission
    for mission in $s1 $s2; do
      name=lost.$1.${mission%%_*}
      lost "$name" "$1" "$mission"
      row "lost, $1 ${mission%%_*}, found within $2, $4 views" "loads everything" ">= $3, $5, 0 wrong" \
        "$(two "$(value "$name" ".found[\"$2\"]")"), $(two "$(value "$name" ".found[\"$4\"]")"), $(value "$name" .wrong) wrong" \
        "$(value "$name" ".found[\"$2\"]") >= $3" "$(value "$name" ".found[\"$4\"]") >= $5" "$(value "$name" .wrong) == 0"
      row "  of those that move within $2, $4 views" - "(to compare)" \
        "$(two "$(value "$name" ".found_of_moved[\"$2\"]")"), $(two "$(value "$name" ".found_of_moved[\"$4\"]")")"
      cut_row "its place cut out of $1, ${mission%%_*}" "cut.$1.${mission%%_*}" "$1" "$mission"
    done
  }
  cut_row() { # WHAT NAME MAP MISSION [OPTION...]
    lost "${@:2}" cut=1
    row "lost, $1, 20 views" - "0 confirmed" "$(value "$2" .confirmed)" "$(value "$2" .confirmed) == 0"
  }
  lost_rows hospital 5 0.93 10 0.98
  lost_rows hospital-small 10 0.90 20 0.98
  for pair in "hospital-small hospital" "hospital hospital-small"; do
    read -r map other <<<"$pair"
    lost "views.$map" "$map" $s1 views="$work/$other"
    row "lost in $map, signatures of $other seen: 5, 10 views" - "(to compare), 0 wrong" \
      "$(two "$(value "views.$map" '.found["5"]')"), $(two "$(value "views.$map" '.found["10"]')"), $(value "views.$map" .wrong) wrong" \
      "$(value "views.$map" .wrong) == 0"
  done
  cut_row "each of hospital's signatures cut out" cut.signatures hospital $s1 views="$work/hospital"
else
  progress "no $bin/localize_lost: the rows of a lost robot are left out"
fi

# What zoneloc keeps of its own beside zoned, both in one cgroup; ten looks a second while the mission is driven.
memory_row() { # WHAT [lost]
  local what=$1 text own code=0
  shift
  progress "memory, $what"
  text=$("$root/tests/system/prove/localizer_memory.sh" "$bin" "$root" "$data/hospital.db" "$data/$s1" 4 "$@" 2>&1) ||
    code=$?
  echo "$text" >"$work/memory.${1:-known}.txt"
  own=$(sed -n 's/^zoneloc, .* looks: at most \([0-9.]*\) MiB of its own.*/\1/p' <<<"$text")
  if [ $code = 77 ]; then
    progress "${text##*$'\n'}: the row is left out"
  else
    row "memory of zoneloc, hospital s1, $what" "914 to 1064 MB" "<= 26 MiB" "${own:-unknown} MiB" "${own:-1000} <= 26" \
      "$code == 0"
  fi
}
if [ -x "$bin/zoned" ]; then
  memory_row "known start"
  memory_row "lost" lost
else
  progress "no $bin/zoned: the rows of memory are left out"
fi

printf '%-52s | %-15s | %-22s | %s\n' what RTAB-Map target measured
printf '%s\n' "${rows[@]}"
echo "$missed of ${#rows[@]} rows missed"
[ "$missed" -eq 0 ]
