#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The checks that take from minutes to hours, each by its option. CONTRIBUTING.md says what for.
set -euo pipefail

usage() {
  cat <<'TEXT'
usage: bash tests/long.sh OPTION...

  --years [FRAMES]      lives of the core and of the adapter in both precisions, 1,000,000 frames
  --sanitizers          all tests with AddressSanitizer and UndefinedBehaviorSanitizer
  --tsan [MINUTES]      ThreadSanitizer over threads of the core, adapter and tool, again and again
                        for 60 minutes
  --fuzz [MINUTES]      fuzz targets, 60 minutes; see tests/fuzz/run.sh
  --worlds [NUMBER]     random worlds of the adapter without sanitizers, 100,000
  --files [NUMBER]      files and command lines for the tool, 100,000 of each kind
  -h, --help            this text
TEXT
}

cd "$(dirname "${BASH_SOURCE[0]}")/.."
jobs="$(nproc)"

# The tests of a preset: build_tests PRESET TARGET...
build_tests() {
  local preset="$1"
  shift
  cmake --preset "$preset" -DCAIRN_TESTS=ON >/dev/null
  cmake --build --preset "$preset" -j "$jobs" --target "$@"
}

years() {
  local programs=(cairn_years_test cairn_adapter_life_test cairn_adapter_life_float64_test)
  build_tests release "${programs[@]}"
  for program in "${programs[@]}"; do
    echo "== $program, $1 frames"
    CAIRN_LIFE_FRAMES="$1" "build/release/tests/$program"
  done
}

sanitizers() {
  cmake --preset asan -DCAIRN_TESTS=ON >/dev/null
  cmake --build --preset asan -j "$jobs"
  ctest --preset asan -j "$jobs" --timeout 7200
}

# Each program once at least, then from the start until the time is up.
tsan() {
  local end=$((SECONDS + 60 * $1)) programs=(cairn_lcp_test cairn_blocks_test cairn_plan_test cairn_faults_test
    cairn_recording_test cairn_adapter_fuzz_test)
  build_tests tsan "${programs[@]}" cairn_tool
  export TSAN_OPTIONS="${TSAN_OPTIONS:-halt_on_error=1}"
  local round=0
  while [[ $round -eq 0 || $SECONDS -lt $end ]]; do
    for program in "${programs[@]}"; do
      [[ $round -eq 0 || $SECONDS -lt $end ]] || break
      echo "== $program, round $round"
      CAIRN_FUZZ_SEED=$((1000 * round)) "build/tsan/tests/$program" --gtest_brief=1
    done
    build/tsan/bin/cairn run castle --size 6 --frames 20 --samples 0 --threads 2 --quiet >/dev/null
    build/tsan/bin/cairn worlds --seeds $((10 * round)):$((10 * round + 4)) --seconds 0.3 --jobs 2 \
      --quiet --progress never >/dev/null
    round=$((round + 1))
  done
  echo "== $round rounds, no data race"
}

worlds() {
  local programs=(cairn_adapter_fuzz_test cairn_adapter_fuzz_float64_test)
  build_tests release "${programs[@]}"
  for program in "${programs[@]}"; do
    CAIRN_FUZZ_RUNS="$1" "build/release/tests/$program"
  done
}

files() {
  build_tests release cairn_tool
  python3 -B tests/fuzz/tool_fuzz.py build/release/bin/cairn --runs "$1"
}

[[ $# -gt 0 ]] || { usage >&2; exit 2; }
bash cmake/install-packages.sh build test
while [[ $# -gt 0 ]]; do
  option="$1"
  shift
  number=''
  if [[ ${1:-} =~ ^[0-9]+$ ]]; then
    number="$1"
    shift
  fi
  case "$option" in
    --years) years "${number:-1000000}" ;;
    --sanitizers) sanitizers ;;
    --tsan) tsan "${number:-60}" ;;
    --fuzz) bash tests/fuzz/run.sh --minutes "${number:-60}" ;;
    --worlds) worlds "${number:-100000}" ;;
    --files) files "${number:-100000}" ;;
    -h | --help) usage ;;
    *)
      usage >&2
      exit 2
      ;;
  esac
done
