#!/usr/bin/env bash
# Builds and tests for every target that one machine can reach, and prints one table: what was built, how many tests
# passed of those that ran, how many golden answers are equal. Hours on a small machine: name targets to do less.
#   bash tests/everywhere.sh [--answers-only] [gcc] [clang] [shared] [threads] [arm64] [windows]
#
#   gcc      GCC, and golden answers of all instruction sets of this CPU
#   clang    likewise
#   shared   shared libraries that show the public interface alone
#   threads  without oneTBB, and with Highway from its archive (CAIRN_FETCH_DEPENDENCIES, from Debian's copy)
#   arm64    64-bit ARM in qemu, with Debian's arm64 packages: core, and Bullet in both precisions, built from its
#            source package: the compiler of Debian's fuses its products and sums, so its worlds go other ways
#   windows  64-bit Windows in wine: core and matrices
#
# Packages come from Debian by apt-get, into build/everywhere; nothing of the system is changed but the group
# `everywhere` of packages.txt, which is installed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root="$PWD" place="$PWD/build/everywhere" jobs="$(nproc)"

answers_only='' targets=()
for word in "$@"; do
  case "$word" in
    --answers-only) answers_only=1 ;;
    gcc | clang | shared | threads | arm64 | windows) targets+=("$word") ;;
    -h | --help) sed -n '2,/^set/p' "${BASH_SOURCE[0]}" | grep '^#'; exit 0 ;;
    *) echo "everywhere.sh: '$word' is no target; see --help" >&2; exit 2 ;;
  esac
done
[[ ${#targets[@]} -gt 0 ]] || targets=(gcc clang shared threads arm64 windows)
bash cmake/install-packages.sh build test everywhere
mkdir -p "$place"
table="$place/table.txt"
: >"$table"
failed=0
launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
plain=(-G Ninja -DCMAKE_BUILD_TYPE=Release -DCAIRN_TOOLS=OFF -DCAIRN_EXAMPLES=OFF -DCAIRN_INSTALL=OFF
       "${launcher[@]}")

# A private apt-get: apt_for FOLDER ARCHITECTURE ARGUMENTS... Debian's own servers and keys.
apt_for() {
  local folder="$1" architecture="$2"
  shift 2
  mkdir -p "$folder"/{state/lists/partial,cache/archives/partial}
  touch "$folder/state/status"
  local key=/usr/share/keyrings/debian-archive-keyring.gpg at=http://deb.debian.org/debian
  printf '%s [signed-by=%s] %s bookworm main\n' deb "$key" "$at" deb-src "$key" "$at" >"$folder/sources.list"
  cat >"$folder/apt.conf" <<TEXT
APT::Architecture "$architecture";
APT::Architectures { "$architecture"; };
APT::Sandbox::User "root";
Dir::State "$folder/state";
Dir::State::status "$folder/state/status";
Dir::Cache "$folder/cache";
Dir::Etc::sourcelist "$folder/sources.list";
Dir::Etc::sourceparts "-";
TEXT
  APT_CONFIG="$folder/apt.conf" apt-get -qq "$@"
}

row() {
  printf '%-10s %-8s %-16s %-16s %s\n' "$@" | tee -a "$table"
}

# answers core|bullet BUILD RUNNER...: golden answers of the programs that were built, as "equal of all"; "-": none.
answers() {
  local build="$2" program equal=0 all=0 line programs=(cairn_answers)
  [[ "$1" == core ]] || programs=(cairn_world_answers cairn_world_answers_float64)
  shift 2
  for program in "${programs[@]}"; do
    [[ -e "$build/bench/verify/$program" || -e "$build/bench/verify/$program.exe" ]] || continue
    local path="$build/bench/verify/$program"
    [[ -e "$path" ]] || path="$path.exe"
    line="$("$@" "$path" 2>>"$place/errors.txt" | tr -d '\r' | tee "$place/$(basename "$build")-$program.txt" |
            tail -n 1 || true)"
    [[ "$line" =~ ^([0-9]+)\ of\ ([0-9]+) ]] || line='0 of 1'
    equal=$((equal + ${line%% *})) all=$((all + $(cut -d ' ' -f 3 <<<"$line")))
  done
  if [[ $all -gt 0 ]]; then echo "$equal of $all"; else echo '-'; fi
}

# all_of TEXT...: whether each "N of M" is all of them.
all_of() {
  local part
  for part in "$@"; do
    [[ "$part" == - || "${part%% *}" == "${part##* }" ]] || return 1
  done
}

# passed BUILD RUNNER...: tests of kernels, core, matrices and adapter, as "passed of run".
passed() {
  local build="$1" test text passed=0 run=0
  shift
  if [[ -n "$answers_only" ]]; then
    echo '-'
    return
  fi
  for test in simd core lcp blocks engine factor recording adapter adapter_float64; do
    local path="$build/tests/cairn_${test}_test"
    [[ -e "$path" ]] || path="$path.exe"
    [[ -e "$path" ]] || continue
    text="$("$@" "$path" --gtest_brief=1 2>&1 | tr -d '\r' | tee "$place/$(basename "$build")-$test.txt" || true)"
    run=$((run + $(sed -n 's/^\[==========\] \([0-9]*\) tests\? .*ran.*/\1/p' <<<"$text" | head -n 1 | grep . || echo 1)))
    passed=$((passed + $(sed -n 's/^\[  PASSED  \] \([0-9]*\) tests\?.*/\1/p' <<<"$text" | head -n 1 | grep . || echo 0)))
  done
  echo "$passed of $run"
}

# target NAME OPTIONS... -- RUNNER...: configures, builds, runs, and writes a line of the table.
target() {
  local name="$1" build="$place/$1" options=()
  shift
  while [[ $# -gt 0 && "$1" != -- ]]; do options+=("$1"); shift; done
  shift
  local programs=(cairn_answers cairn_world_answers cairn_world_answers_float64)
  if [[ -z "$answers_only" ]]; then
    programs+=(cairn_{simd,core,lcp,blocks,engine,factor,recording,adapter,adapter_float64}_test)
  fi
  if ! cmake -S "$root" -B "$build" "${plain[@]}" -DCAIRN_TESTS=ON "${options[@]}" >"$build.log" 2>&1; then
    failed=1
    row "$name" no - - "configuring failed: $build.log"
    return
  fi
  local known wanted=() program
  known="$(cmake --build "$build" --target help)"
  for program in "${programs[@]}"; do
    if grep -q "^$program[:.]" <<<"$known"; then wanted+=("$program"); fi
  done
  if ! cmake --build "$build" -j "$jobs" --target "${wanted[@]}" >>"$build.log" 2>&1; then
    failed=1
    row "$name" no - - "building failed: $build.log"
    return
  fi
  local tests core bullet
  tests="$(passed "$build" "$@")" core="$(answers core "$build" "$@")" bullet="$(answers bullet "$build" "$@")"
  row "$name" yes "$tests" "$core" "$bullet"
  # Bullet takes angles of joints from the C library, which is another one there
  [[ "$name" != arm64 ]] || bullet='-'
  all_of "$tests" "$core" "$bullet" || failed=1
}

x86_targets() {
  local name="$1" simd
  for simd in scalar sse4 avx2 avx512; do
    if [[ "$(env CAIRN_SIMD=$simd "$place/$name/bench/verify/cairn_answers" --target 2>/dev/null)" != "$simd" ]]; then
      continue
    fi
    local core bullet
    core="$(answers core "$place/$name" env CAIRN_SIMD=$simd)"
    bullet="$(answers bullet "$place/$name" env CAIRN_SIMD=$simd)"
    row "  $simd" yes - "$core" "$bullet"
    all_of "$core" "$bullet" || failed=1
  done
}

do_gcc() {
  target gcc -DCMAKE_CXX_COMPILER=g++ -- env
  x86_targets gcc
}

do_clang() {
  target clang -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang -- env
  x86_targets clang
}

do_shared() {
  local build="$place/shared"
  if cmake -S . -B "$build" "${plain[@]}" -DBUILD_SHARED_LIBS=ON -DCAIRN_TESTS=OFF >"$build.log" 2>&1 &&
     cmake --build "$build" -j "$jobs" >>"$build.log" 2>&1; then
    local said
    said="$(python3 -B tests/checks/exports.py "$build" | tail -n 1)" || failed=1
    row shared yes - - "$said"
  else
    failed=1
    row shared no - - "building failed: $build.log"
  fi
}

debian_sources() {
  local folder="$place/sources"
  [[ ! -e "$folder/$1" ]] || return 0
  apt_for "$folder" amd64 update
  (cd "$folder" && apt_for "$folder" amd64 source --download-only "$1" && dpkg-source -x "$1"_*.dsc "$1") >/dev/null
}

do_threads() {
  debian_sources highway
  target threads -DCAIRN_TBB=OFF -DCAIRN_BULLET=off -DCAIRN_FETCH_DEPENDENCIES=ON -DCMAKE_DISABLE_FIND_PACKAGE_hwy=ON \
    -DCAIRN_HIGHWAY_URL="$(echo "$place"/sources/highway_*.orig.tar.gz)" -- env
}

# Bullet for ARM in both precisions, with the bits that it has on x86: nothing fused.
bullet_for_arm64() {
  local folder="$1" double
  debian_sources bullet
  for double in OFF ON; do
    cmake -S "$place/sources/bullet" -B "$folder/bullet-$double" -G Ninja -DCMAKE_BUILD_TYPE=Release \
      -DCMAKE_TOOLCHAIN_FILE="$root/cmake/toolchains/aarch64-linux-gnu.cmake" -DUSE_DOUBLE_PRECISION="$double" \
      -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG -ffp-contract=off" -DBUILD_SHARED_LIBS=ON -DINSTALL_LIBS=ON \
      -DBUILD_BULLET3=OFF -DBUILD_BULLET2_DEMOS=OFF -DBUILD_CPU_DEMOS=OFF -DBUILD_EXTRAS=OFF \
      -DBUILD_OPENGL3_DEMOS=OFF -DBUILD_PYBULLET=OFF -DBUILD_UNIT_TESTS=OFF -DCMAKE_POLICY_VERSION_MINIMUM=3.5 \
      -Wno-dev >"$folder/bullet-$double.log" 2>&1
    local suffix=''
    [[ "$double" == OFF ]] || suffix=-float64
    cmake --build "$folder/bullet-$double" -j "$jobs" --target "BulletDynamics$suffix" >>"$folder/bullet-$double.log"
  done
  mkdir -p "$folder/bullet"
  cp -a "$folder"/bullet-{OFF,ON}/src/*/lib*.so* "$folder/bullet"
}

do_arm64() {
  local folder="$place/arm64-packages"
  if [[ ! -e "$folder/root" ]]; then
    apt_for "$folder" arm64 update
    mkdir -p "$folder/debs"
    (cd "$folder/debs" && apt_for "$folder" arm64 download libtbb-dev libtbb12 libtbbmalloc2 libtbbbind-2-5 libhwloc15 \
      libhwy-dev libhwy1 libgtest-dev libgmock-dev librapidcheck-dev libbullet-dev libbullet3.24 libeigen3-dev \
      nlohmann-json3-dev libfmt-dev)
    for deb in "$folder"/debs/*.deb; do dpkg -x "$deb" "$folder/root"; done
  fi
  export CAIRN_SYSROOT="$folder/root"
  [[ -e "$folder/bullet" ]] || bullet_for_arm64 "$folder"
  target arm64 -DCMAKE_TOOLCHAIN_FILE="$root/cmake/toolchains/aarch64-linux-gnu.cmake" -- \
    qemu-aarch64-static -L /usr/aarch64-linux-gnu \
    -E "LD_LIBRARY_PATH=$folder/bullet:$folder/root/usr/lib/aarch64-linux-gnu"
}

do_windows() {
  local folder="$place/windows-packages" toolchain="$root/cmake/toolchains/x86_64-w64-mingw32.cmake"
  export CAIRN_SYSROOT="$folder/root" WINEDEBUG=-all WINEPREFIX="$folder/wine"
  if [[ ! -e "$folder/root" ]]; then
    debian_sources highway
    mkdir -p "$folder/root/usr/include" "$folder/root/usr/share"
    local cross=(-G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_TOOLCHAIN_FILE="$toolchain"
                 -DCMAKE_INSTALL_PREFIX="$folder/root/usr")
    cmake -S "$place/sources/highway" -B "$folder/highway" "${cross[@]}" -DBUILD_SHARED_LIBS=OFF -DBUILD_TESTING=OFF \
      -DHWY_ENABLE_EXAMPLES=OFF -DHWY_ENABLE_CONTRIB=OFF -DHWY_FORCE_STATIC_LIBS=ON >/dev/null
    cmake --build "$folder/highway" --target install >/dev/null
    cmake -S /usr/src/googletest -B "$folder/gtest" "${cross[@]}" >/dev/null
    cmake --build "$folder/gtest" --target install >/dev/null
    # headers alone, the same everywhere
    cp -r /usr/include/eigen3 /usr/include/nlohmann "$folder/root/usr/include"
    cp -r /usr/share/eigen3 /usr/share/cmake "$folder/root/usr/share"
  fi
  target windows -DCMAKE_TOOLCHAIN_FILE="$toolchain" -DCAIRN_TBB=OFF -DCAIRN_BULLET=off \
    -DCMAKE_DISABLE_FIND_PACKAGE_rapidcheck=ON -- /usr/lib/wine/wine64
}

row target builds 'tests passed' 'answers: core' "Bullet's worlds"
for name in "${targets[@]}"; do "do_$name"; done
echo
cat "$table"
exit "$failed"
