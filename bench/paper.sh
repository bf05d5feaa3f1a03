#!/usr/bin/env bash
# Writes docs/paper.md: the experiments of the paper on problems that anyone can rerun.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/usage.sh" "$@" <<'TEXT'
usage: bash bench/paper.sh [--keep]

  --keep   measure only what out/paper does not hold yet

Builds the cairn tool, solves every problem of docs/paper.md, writes it and its figures. 15 to 30 minutes.
Environment: CAIRN_PROBLEMS, a folder of problems in the format of `cairn solve` (../shared/problems/open);
the sections on them are left out where it is absent.
TEXT

cd "$root"
bash bench/build-tool.sh build peers
python3 bench/paper/paper.py --cairn build/release/bin/cairn --out out/paper --docs docs \
  --problems "${CAIRN_PROBLEMS:-../shared/problems/open}" "$@"
