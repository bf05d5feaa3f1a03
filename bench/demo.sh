#!/usr/bin/env bash
# Shoots at the castle in a real Bullet world: Bullet's own solvers and Cairn under the same budget per frame.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/usage.sh" "$@" <<'TEXT'
usage: bash bench/demo.sh [OPTIONS OF cairn run...]

Options are added to those below, for example:  bash bench/demo.sh --size 2 --seed 7
Environment: BUDGET (16ms, a frame at 60 Hz) for each solver, FRAMES (300).
TEXT

cd "$root"
budget="${BUDGET:-16ms}"
frames="${FRAMES:-300}"

bash bench/build-tool.sh build

mkdir -p out
run=(build/release/bin/cairn run castle
  --solver "bullet-si,bullet-si@fit,bullet-nncg,cairn"
  --budget "$budget" --frames "$frames" --samples 4
  --json out/castle.json --csv out/castle.csv --report out/castle.html "$@")
echo "== ${run[*]}"
"${run[@]}"

echo
echo "Written: out/castle.json, out/castle.csv and the page:"
echo "  $PWD/out/castle.html"
