#!/usr/bin/env bash
# Installs what is missing, builds everything and runs all tests.
set -euo pipefail

usage() {
  cat <<'TEXT'
usage: bash tests/run.sh [--preset NAME] [CTEST OPTIONS...]

  --preset NAME   release (default), dev, asan or tsan
  -h, --help      this text

All else goes to ctest:  bash tests/run.sh -R solver --verbose
TEXT
}

preset=release
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
    *) break ;;
  esac
done

cd "$(dirname "${BASH_SOURCE[0]}")/.."
jobs="$(nproc)"

folder="build/$preset"
bash cmake/install-packages.sh build test
echo "== Configuring $folder"
cmake --preset "$preset" -DCAIRN_TESTS=ON
echo "== Building ($jobs jobs)"
cmake --build "$folder" -j "$jobs"
echo "== Testing"
ctest --test-dir "$folder" --output-on-failure -j "$jobs" "$@"
