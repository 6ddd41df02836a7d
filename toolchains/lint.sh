# SPDX-License-Identifier: Apache-2.0
# Sourced by toolchains/run: what is checked without running our code. All of it, then the verdict.

lint() {
  local bad=() check
  for check in format scripts documents tidy; do
    stage "lint: $check"
    "lint_$check" || bad+=("$check")
  done
  ((${#bad[@]} == 0)) || { echo "lint: findings in ${bad[*]}"; return 1; }
}

lint_format() {
  local findings=0
  git ls-files '*.cpp' '*.hpp' '*.c' '*.h' | xargs clang-format --dry-run -Werror || findings=1
  if git grep -nE '//.*[^ ] +(Invariant|Real-time|Threads|Memory|Ownership): ' '*.hpp'; then
    echo "a contract begins a line of its own"
    findings=1
  fi
  return $findings
}

# Sourced scripts are checked with those that source them; the guest's shell is dash.
lint_scripts() {
  local findings=0
  git grep -lE '^#!.*[/ ](ba)?sh$' | xargs shellcheck --check-sourced || findings=1
  shellcheck --check-sourced --shell=dash tests/system/guest/*_test.sh || findings=1
  return $findings
}

lint_documents() { python3 tests/system/documents_test.py . build/test/bin; }

# clang-tidy on the batches of sources that the preset `clang` compiles: each header is read once a batch. A batch is
# checked again when it, its options, .clang-tidy or a header of it changed: the name of its record is a digest of those.
lint_tidy() {
  local generated=(zonepack_views_schemas zonepack_protocol_schemas zonepack_version_commit)
  configure clang && cmake --build --preset clang --target "${generated[@]}" >/dev/null && mkdir -p build/clang/tidy &&
    jq -r '.[].file | select(test("/(platform|runtime|packer)/CMakeFiles/"))' build/clang/compile_commands.json |
    xargs -P "$(nproc)" -n 1 toolchains/tidy_batch.sh
}
