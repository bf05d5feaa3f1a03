#!/usr/bin/env bash
# Shoots at the castle in a real Bullet world: Bullet's own solvers and Cairn under the same budget per frame.
set -euo pipefail

usage() {
  cat <<'TEXT'
usage: bash bench/demo.sh [OPTIONS OF cairn run...]

Options are added to those below, for example:  bash bench/demo.sh --size 2 --seed 7
Environment: BUDGET (16ms, a frame at 60 Hz) for each solver, FRAMES (300).
TEXT
}

case "${1:-}" in
  -h | --help)
    usage
    exit 0
    ;;
esac

cd "$(dirname "${BASH_SOURCE[0]}")/.."
budget="${BUDGET:-16ms}"
frames="${FRAMES:-300}"

bash cmake/install-packages.sh build
echo "== Building the cairn tool"
# The folder of the tests, so that nothing is built twice; a first build here does without the tests.
first=()
[[ -f build/release/CMakeCache.txt ]] || first=(-DCAIRN_TESTS=OFF)
cmake --preset release "${first[@]}"
cmake --build --preset release -j "$(nproc)" --target cairn_tool

mkdir -p out
run=(build/release/bin/cairn run castle
  --solver "bullet-si,bullet-si@fit,bullet-nncg,bullet-dantzig,cairn"
  --budget "$budget" --frames "$frames" --samples 4
  --json out/castle.json --csv out/castle.csv --report out/castle.html "$@")
echo "== ${run[*]}"
"${run[@]}"

echo
echo "Written: out/castle.html (the page), out/castle.json, out/castle.csv"
