# SPDX-License-Identifier: Apache-2.0
# zoneloc on the robot: the closed loop over half a minute of the sample drive accepts the images that the host
# accepted, up to one in twenty, at poses that differ by 5 mm in x and y and by 0.1 degrees at most; and a second time
# gives the same bytes.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
mkdir first again
began=$(centiseconds)
sh /payload/tests/closed_loop.sh zoneloc "$config" /payload first >said.txt 2>&1 || fail "$(cat said.txt)"
took=$(($(centiseconds) - began))
sh /payload/tests/closed_loop.sh zoneloc "$config" /payload again >/dev/null 2>&1 || fail "the second time failed"
cmp first/fixes.txt again/fixes.txt || fail "two runs gave different fixes"
holds first/loop.json wrong 0
holds first/loop.json budget_violations 0
awk '/^#/ { next }
  FNR == NR { at[$1] = $0; host++; next }
  !($1 in at) { ours++; next }
  { split(at[$1], h); both++
    for (i = 3; i <= 5; ++i) { d[i] = $i - h[i]; if (d[i] < 0) d[i] = -d[i] }
    if (d[3] > most) most = d[3]
    if (d[4] > most) most = d[4]
    if (d[5] > 3.14159) d[5] = 6.28318530718 - d[5]
    if (d[5] > widest) widest = d[5] }
  END {
    apart = (host - both) + ours
    printf "%d of the host'"'"'s %d fixes, %d others; at most %.2f mm and %.4f degrees apart\n", both, host, ours,
      most * 1000, widest * 57.29578
    exit !(host >= 20 && apart * 20 <= host && most <= 0.005 && widest * 57.29578 <= 0.1)
  }' /payload/loop/fixes.txt first/fixes.txt >told || fail "$(cat told)"
echo "$(cat told); $((took / 100)) s for $(value first/loop.json images) images"
