#!/usr/bin/env bash
# Builds Bullet from the source package of Debian or Ubuntu with what its classes "Mt" need, which the
# distributions leave out: locks that lock (BT_THREADSAFE). Both precisions; nothing outside its folders is touched.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
prefix="$root/build/bullet-mt"
work="$root/build/bullet-mt-source"
jobs="$(nproc)"

usage() {
  cat <<TEXT
usage: bash cmake/build-bullet-mt.sh [--prefix DIR] [--source DIR] [--jobs N]

  --prefix DIR   where it is installed; build/bullet-mt if left out
  --source DIR   sources of Bullet that are here already; otherwise those of the package are fetched
  --jobs N       compilers at a time; as many as there are cores if left out

Then   cmake -B build/mt -DBULLET_ROOT=DIR   or BULLET_ROOT in the environment.
TEXT
}

source=''
while [[ $# -gt 0 ]]; do
  case "$1" in
    -h | --help)
      usage
      exit 0
      ;;
    --prefix) prefix="${2:?--prefix needs a folder}" && shift 2 ;;
    --source) source="${2:?--source needs a folder}" && shift 2 ;;
    --jobs) jobs="${2:?--jobs needs a number}" && shift 2 ;;
    *)
      usage >&2
      exit 2
      ;;
  esac
done

# Sources of the package, from where this machine gets its packages: apt's own lists say where that is, and its
# own keys what is genuine. All state is kept in a folder of its own, so this needs no root.
fetch() {
  local state="$work/apt"
  mkdir -p "$state/lists/partial" "$state/cache/archives/partial"
  apt-get indextargets --format '$(REPO_URI) $(CODENAME) $(COMPONENT)' 'Created-By: Packages' |
    sort -u | while read -r uri suite component; do
      [[ "$component" == main || "$component" == universe ]] || continue
      echo "deb-src [signed-by=$1] $uri $suite $component"
    done >"$state/sources.list"
  local options=(-q -o "Dir::Etc::SourceList=$state/sources.list" -o Dir::Etc::SourceParts=/dev/null
    -o "Dir::State::Lists=$state/lists" -o "Dir::Cache=$state/cache" -o APT::Sandbox::User=)
  # sources of others that this machine also has may have no key here, or no sources: that is no failure
  apt-get "${options[@]}" update >"$work/update.log" 2>&1 || true
  (cd "$work" && apt-get "${options[@]}" source bullet >"$work/fetch.log" 2>&1)
}

if [[ -z "$source" ]]; then
  for tool in apt-get dpkg-source cmake; do
    command -v "$tool" >/dev/null && continue
    echo "build-bullet-mt.sh: there is no $tool here (packages apt, dpkg-dev, cmake). With sources of Bullet 3.24" >&2
    echo "that you have, give --source DIR." >&2
    exit 1
  done
  echo "== Fetching the source package of Bullet"
  rm -rf "$work"
  mkdir -p "$work"
  keys=''
  for key in /usr/share/keyrings/{debian,ubuntu}-archive-keyring.gpg; do
    [[ -f "$key" ]] && keys="${keys:+$keys,}$key"
  done
  if ! fetch "$keys"; then
    echo "build-bullet-mt.sh: the sources could not be fetched:" >&2
    tail -n 3 "$work/update.log" "$work/fetch.log" >&2
    echo "apt-get update may help; or give --source DIR." >&2
    exit 1
  fi
  source="$(find "$work" -mindepth 1 -maxdepth 1 -type d -name 'bullet-*' | head -n 1)"
fi
[[ -f "$source/src/LinearMath/btThreads.h" ]] || {
  echo "build-bullet-mt.sh: $source has no sources of Bullet" >&2
  exit 1
}

# -O2, as the distributions build it
for double in OFF ON; do
  echo "== Building $(basename "$source") with BT_THREADSAFE, double precision $double"
  cmake -S "$source" -B "$work/build-$double" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG" \
    -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_POLICY_VERSION_MINIMUM=3.5 -DBUILD_SHARED_LIBS=ON \
    -DBULLET2_MULTITHREADING=ON -DUSE_DOUBLE_PRECISION="$double" \
    -DBUILD_BULLET3=OFF -DBUILD_BULLET2_DEMOS=OFF -DBUILD_CPU_DEMOS=OFF -DBUILD_EXTRAS=OFF -DBUILD_OPENGL3_DEMOS=OFF \
    -DBUILD_PYBULLET=OFF -DBUILD_UNIT_TESTS=OFF -DINSTALL_LIBS=ON -Wno-dev >"$work/configure-$double.log"
  cmake --build "$work/build-$double" -j "$jobs" >"$work/build-$double.log"
  cmake --install "$work/build-$double" >"$work/install-$double.log"
done
# what is inline in its headers must lock as well
sed -i 's/^Cflags: .*/& -DBT_THREADSAFE=1/' "$prefix"/lib/pkgconfig/bullet*.pc
echo "Bullet for several threads is in $prefix: cmake -DBULLET_ROOT=$prefix"
