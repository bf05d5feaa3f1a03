#!/bin/bash
# SPDX-License-Identifier: MIT
# Runs the fuzz targets under ASan and UBSan, one after the other in equal shares of the time, from
# the root of the source:
#   tests/fuzz/run.sh [--minutes N] [--jobs N] [--corpus-only] [TARGET...]
# Targets: contact, matrix, recording; default all. They begin with tests/fuzz/corpus/TARGET. What
# they find is written to build/fuzz, what covers more stays in build/fuzz/corpus/TARGET;
# --keep N adds the N smallest of a minimised corpus to the one of the repository.
# Frames that `cairn record` writes are added to the recordings where CAIRN names the tool.
set -euo pipefail
minutes=5 jobs=1 only_corpus= keep= targets=()
while [ $# -gt 0 ]; do
  case $1 in
    --minutes) minutes=$2; shift 2 ;;
    --jobs) jobs=$2; shift 2 ;;
    --keep) keep=$2; shift 2 ;;
    --corpus-only) only_corpus=1; shift ;;
    contact|matrix|recording) targets+=("$1"); shift ;;
    *) echo "usage: $0 [--minutes N] [--jobs N] [--keep N] [--corpus-only] [TARGET...]" >&2; exit 2 ;;
  esac
done
[ ${#targets[@]} -gt 0 ] || targets=(contact matrix recording)
build=build/fuzz
cmake --preset fuzz
cmake --build $build --target cairn_{recording,contact,matrix}_fuzz cairn_recording_seeds
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
  kept=tests/fuzz/corpus/$target
  mkdir -p "$corpus" "$build/seeds/$target" "$kept"
  find "$kept" "$build/seeds/$target" -type f -print0 | xargs -0 -r "$fuzzer" -timeout=20
  [ -z "$only_corpus" ] || continue
  nice "$fuzzer" -max_total_time=$seconds -timeout=20 -rss_limit_mb=2048 -max_len=65536 -jobs=0 \
    -fork=$jobs -ignore_crashes=0 -artifact_prefix=$build/"$target"- \
    "$corpus" "$kept" "$build/seeds/$target"
  [ -z "$keep" ] || {
    rm -rf "$corpus.small" && mkdir "$corpus.small"
    "$fuzzer" -merge=1 "$corpus.small" "$kept" "$corpus"
    find "$corpus.small" -type f -printf '%s %p\n' | sort -n | head -n "$keep" | cut -d' ' -f2- |
      xargs -r cp -t "$kept"
  }
done
