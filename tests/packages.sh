#!/usr/bin/env bash
# Whether a game can be made with the Debian packages alone: installs those of a folder (default out/debs), compiles the
# example of the two changed lines outside of this tree by g++ and pkg-config, and runs it; then asks the tool for the
# golden answers, and compares the interface of libcairn with the one that is kept.
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
(
  cd "$place"
  for package in cairn-bullet cairn-bullet-float64; do
    # shellcheck disable=SC2046
    g++ game.cc $(pkg-config --cflags --libs "$package") -o "$package"
    "./$package"
  done
)
cairn doctor --verify
cairn list scenes >/dev/null
rm -rf "$place"
echo "== The packages in $folder are enough for a game"
