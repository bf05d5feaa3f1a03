#!/usr/bin/env bash
# Whether a game can be made with the Debian packages alone: installs those of a folder (default out/debs), compiles the
# example of the two changed lines, and a program in C, outside of this tree by pkg-config, and runs them and a script in
# Python; then asks the tool for the golden answers, and compares what the libraries show with what is kept.
#   bash tests/packages.sh [--keep] [FOLDER]
# Takes the packages out again, unless --keep says not to.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
keep=''
if [[ "${1:-}" == --keep ]]; then keep=1; shift; fi
folder="$(realpath "${1:-out/debs}")"
mapfile -t debs < <(ls "$folder"/libcairn*.deb "$folder"/cairn-tools*.deb)

apt-get -qq install -y --no-install-recommends "${debs[@]}" </dev/null
take_out() {
  if [[ -z "$keep" ]]; then apt-get -qq remove -y 'libcairn*' cairn-tools </dev/null >/dev/null; fi
}
trap take_out EXIT

place="$(mktemp -d)"
cp examples/bullet_swap.cc "$place/game.cc"
cp examples/tower.c examples/engine.c examples/python/*.py "$place"
(
  cd "$place"
  for package in cairn-bullet cairn-bullet-float64; do
    # shellcheck disable=SC2046
    g++ game.cc $(pkg-config --cflags --libs "$package") -o "$package"
    "./$package"
  done
  # shellcheck disable=SC2046
  cc -std=c11 tower.c $(pkg-config --cflags --libs cairn-c) -o tower
  ./tower
  # shellcheck disable=SC2046
  cc -std=c11 engine.c $(pkg-config --cflags --libs cairn-c) -lm -o engine
  ./engine
  if python3 -c 'import numpy' 2>/dev/null; then python3 -B error_against_sweeps.py; fi
)
# stripped: their globals are looked at where they are built
python3 -B tests/checks/exports.py "/usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)"
cairn doctor --verify
cairn list scenes >/dev/null
rm -rf "$place"
echo "== The packages in $folder are enough for a game"
