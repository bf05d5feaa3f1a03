#!/bin/sh
# SPDX-License-Identifier: MIT
# Fuzzes the reader of recordings: tests/fuzz/run.sh [SECONDS], from the root of the source.
# Frames that `cairn record` writes are added to the seeds where CAIRN names the tool.
set -e
seconds=${1:-300}
build=build/fuzz
corpus=$build/corpus
cmake --preset fuzz
cmake --build $build --target cairn_recording_fuzz cairn_recording_seeds
mkdir -p $corpus
$build/bin/cairn_recording_seeds $build/seeds
if [ -n "$CAIRN" ]; then
  for scene in tower chain ragdolls; do "$CAIRN" record $scene --size 3 --frames 20 -o $build/seeds; done
fi
# what it finds is written to the folder of the build
exec nice $build/bin/cairn_recording_fuzz -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 \
  -max_len=65536 -artifact_prefix=$build/ $corpus $build/seeds
