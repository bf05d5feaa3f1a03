#!/usr/bin/env bash
# Builds the Debian packages of this tree, looks at them with lintian, and puts them into out/debs (or the folder given):
#   bash packaging/build-debs.sh [FOLDER]
# CAIRN_CXX_LAUNCHER names a compiler launcher, such as ccache.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
target="$(realpath -m "${1:-out/debs}")"
work="$PWD/build/debs"

bash cmake/install-packages.sh build packaging
rm -rf "$work"
mkdir -p "$work/cairn" "$target"
tar --exclude=./build --exclude=./out --exclude=./.git -cf - . | tar -xf - -C "$work/cairn"
cp -r packaging/debian "$work/cairn/debian"

cd "$work/cairn"
if [[ -n "${CAIRN_CXX_LAUNCHER:-}" ]]; then export CMAKE_CXX_COMPILER_LAUNCHER="$CAIRN_CXX_LAUNCHER"; fi
dpkg-buildpackage --build=binary --unsigned-changes --unsigned-source
cd ..
lintian --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs ./*.changes
cp ./*.deb "$target"
echo "== In $target:"
ls -l "$target"
