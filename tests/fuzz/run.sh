#!/bin/bash
# SPDX-License-Identifier: MIT
# Runs the fuzz targets under ASan and UBSan, one after the other in equal shares of the time:
#   tests/fuzz/run.sh [--minutes N] [--jobs N] [--corpus-only] [--build DIR] [TARGET...]
# Targets: contact, matrix, recording, world; default all. They begin with tests/fuzz/corpus/TARGET.
# What they find is written to build/fuzz, what covers more stays in build/fuzz/corpus/TARGET;
# --keep N adds the N smallest of a minimised corpus to the one of the repository.
# --build DIR is a folder that is configured already, with the preset fuzz and options of its own.
# Frames that `cairn record` writes are added to the recordings where CAIRN names the tool.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
all=(contact matrix recording world)
minutes=5 jobs=1 only_corpus='' keep='' build='' targets=()
while [ $# -gt 0 ]; do
  case $1 in
    --minutes) minutes=${2:?--minutes needs a number}; shift 2 ;;
    --jobs) jobs=${2:?--jobs needs a number}; shift 2 ;;
    --keep) keep=${2:?--keep needs a number}; shift 2 ;;
    --build) build=${2:?--build needs a folder}; shift 2 ;;
    --corpus-only) only_corpus=1; shift ;;
    contact|matrix|recording|world) targets+=("$1"); shift ;;
    *) echo "usage: $0 [--minutes N] [--jobs N] [--keep N] [--corpus-only] [--build DIR] [TARGET...]" >&2; exit 2 ;;
  esac
done
[ ${#targets[@]} -gt 0 ] || targets=("${all[@]}")

export UBSAN_OPTIONS="${UBSAN_OPTIONS:-}:print_stacktrace=1"
bash cmake/install-packages.sh build test fuzz
[ -n "$build" ] || { build=build/fuzz && cmake --preset fuzz >/dev/null; }
echo "== Building the targets: $build"
cmake --build $build --target cairn_recording_seeds $(printf "cairn_%s_fuzz " "${targets[@]}")
mkdir -p $build/seeds/recording
$build/bin/cairn_recording_seeds $build/seeds/recording
if [ -n "${CAIRN:-}" ]; then
  for scene in tower chain ragdolls; do
    "$CAIRN" record $scene --size 3 --frames 20 -o $build/seeds/recording
  done
fi

seconds=$((minutes * 60 / ${#targets[@]}))
for target in "${targets[@]}"; do
  fuzzer=$build/bin/cairn_${target}_fuzz corpus=$build/corpus/$target
  kept=tests/fuzz/corpus/$target seeds=$build/seeds/$target log=$build/$target.log
  mkdir -p "$corpus" "$seeds"
  folders=("$seeds")
  [ ! -d "$kept" ] || folders+=("$kept")
  echo "== $target: $(find "${folders[@]}" -type f | wc -l) inputs that are kept"
  find "${folders[@]}" -type f -print0 | xargs -0 -r "$fuzzer" -timeout=20 2>"$log" ||
    { tail -n 60 "$log"; exit 1; }
  [ -z "$only_corpus" ] || continue
  # one process is faster without the parent that -fork makes
  [ "$jobs" -eq 1 ] && fork=() || fork=(-fork="$jobs" -ignore_crashes=0)
  nice "$fuzzer" -max_total_time=$seconds -timeout=20 -rss_limit_mb=2048 -max_len=65536 "${fork[@]}" \
    -artifact_prefix=$build/"$target"- "$corpus" "${folders[@]}" 2>"$log" ||
    { tail -n 60 "$log"; exit 1; }
  runs=$(grep -oE '^#[0-9]+' "$log" | tail -n 1)
  echo "== $target: ${runs#\#} inputs in $seconds s, no finding"
  [ -z "$keep" ] || {
    rm -rf "$corpus.small" && mkdir "$corpus.small"
    "$fuzzer" -merge=1 "$corpus.small" "${folders[@]}" "$corpus"
    mkdir -p "$kept"
    find "$corpus.small" -type f -printf '%s %p\n' | sort -n | head -n "$keep" | cut -d' ' -f2- |
      xargs -r cp -t "$kept"
  }
done
