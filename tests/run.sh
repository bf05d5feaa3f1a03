#!/usr/bin/env bash
# Installs what is missing, builds everything and runs all tests.
set -euo pipefail

usage() {
  cat <<'TEXT'
usage: bash tests/run.sh [--preset NAME | --quick] [CTEST OPTIONS...]

  --preset NAME   release (default), dev, asan or tsan
  --quick         a release in build/quick that takes less time to build from nothing (CAIRN_QUICK_BUILD)
                  and in which warnings are errors; tests are optimised less
  -h, --help      this text

All else goes to ctest:  bash tests/run.sh -R solver --verbose
TEXT
}

preset=release
folder=''
options=()
while [[ $# -gt 0 ]]; do
  case "$1" in
    -h | --help)
      usage
      exit 0
      ;;
    --preset)
      preset="${2:?--preset needs a name}"
      shift 2
      ;;
    --quick)
      folder=build/quick
      options=(-DCAIRN_QUICK_BUILD=ON -DCAIRN_WERROR=ON)
      shift
      ;;
    *) break ;;
  esac
done

cd "$(dirname "${BASH_SOURCE[0]}")/.."
jobs="$(nproc)"

folder="${folder:-build/$preset}"
bash cmake/install-packages.sh build test
echo "== Configuring $folder"
cmake --preset "$preset" -B "$folder" -DCAIRN_TESTS=ON "${options[@]}"
echo "== Building ($jobs jobs)"
cmake --build "$folder" -j "$jobs"
echo "== Testing"
ctest --test-dir "$folder" --output-on-failure -j "$jobs" "$@"
