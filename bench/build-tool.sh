#!/usr/bin/env bash
# Installs the named groups of packages.txt and builds the cairn tool: build/release/bin/cairn
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash cmake/install-packages.sh "$@"
# The page has a replay only with it; the rest does without, and so does the window.
command -v npm >/dev/null || [[ " $* " == *" play "* ]] || bash cmake/install-packages.sh node || echo "Without npm: pages will have no replay."
echo "== Building the cairn tool"
# The folder of the tests, so that nothing is built twice; a first build here does without the tests.
first=()
[[ -f build/release/CMakeCache.txt ]] || first=(-DCAIRN_TESTS=OFF)
cmake --preset release "${first[@]}"
cmake --build --preset release -j "$(nproc)" --target cairn_tool
