#!/usr/bin/env bash
# The full report: scenes under budgets of 0.5, 2, 4 and 16 ms, a page for each, and their table.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/usage.sh" "$@" <<'TEXT'
usage: bash bench/report.sh [OPTIONS OF cairn run...]

Writes out/report-BUDGET.html, .json and .md, and out/report_table.md. Under ten minutes on two quiet cores.
Options are added to those below, for example:  bash bench/report.sh --frames 60
Environment: BUDGETS (0.5ms 2ms 4ms 16ms), SCENES (the twelve that are not small, or all), SOLVERS (bullet-si,bullet-si@fit,cairn).
TEXT

cd "$root"
read -ra budgets <<<"${BUDGETS:-0.5ms 2ms 4ms 16ms}"
read -ra scenes <<<"${SCENES:-castle pyramid pyramid3d wall tower heavy-top bridge two-pin-bridge chain ragdolls rubble islands}"
solvers="${SOLVERS:-bullet-si,bullet-si@fit,cairn}"

bash bench/build-tool.sh build

mkdir -p out
files=()
for i in "${!budgets[@]}"; do
  budget="${budgets[$i]}"
  out="out/report-$budget"
  run=(build/release/bin/cairn run "${scenes[@]}" --solver "$solvers" --budget "$budget" --frames 240 --samples 4
    --json "$out.json" --markdown "$out.md" --report "$out.html" --quiet "$@")
  echo "== $((i + 1)) of ${#budgets[@]}, minute $((SECONDS / 60)): ${run[*]}"
  # exit code 1: a solver of Cairn failed, and the tables say so
  "${run[@]}" --progress always >/dev/null || [[ $? -eq 1 ]]
  files+=("$out.json")
done

python3 bench/report_table.py "${files[@]}" >out/report_table.md
cat out/report_table.md
echo
echo "Written after $((SECONDS / 60)) minutes: out/report_table.md, and for each budget a page:"
for budget in "${budgets[@]}"; do echo "  $PWD/out/report-$budget.html"; done
