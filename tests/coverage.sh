#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Which lines of core/ and simd/ the tests of the core and its kernels run:
#   bash tests/coverage.sh [--lines]      --lines names those that none runs
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash cmake/install-packages.sh build test
build=build/coverage
programs=(cairn_{blocks,core,factor,factor_no_alloc,faults,fuzz,lcp,lcp_folders,no_alloc,recording,simd}_test)

echo "== Building: $build"
# counters that threads may share
cmake -S . -B $build -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-g -O1" \
  -DCMAKE_CXX_FLAGS="--coverage -fprofile-update=atomic" -DCAIRN_BULLET=OFF -DCAIRN_TOOLS=OFF \
  -DCAIRN_TESTS=ON -DCAIRN_EXAMPLES=OFF >/dev/null
cmake --build $build --target "${programs[@]}"
find $build -name '*.gcda' -delete
echo "== Testing"
failed=0
for program in "${programs[@]}"; do
  CAIRN_FUZZ_RUNS=${CAIRN_FUZZ_RUNS:-300} $build/tests/"$program" --gtest_brief=1 || failed=1
done
python3 -B tests/coverage.py $build "$@"
exit $failed
