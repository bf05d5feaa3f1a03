#!/usr/bin/env bash
# Installs the packages of the named groups of packages.txt that are not there yet:
#   bash cmake/install-packages.sh build test
set -euo pipefail

list="$(dirname "${BASH_SOURCE[0]}")/../packages.txt"

# The names in the groups given as arguments.
packages_of() {
  local group='' line
  while read -r line; do
    case "$line" in
      '' | '#'*) ;;
      '['*']') group="${line:1:-1}" ;;
      *) [[ " $* " == *" $group "* ]] && echo "$line" ;;
    esac
  done <"$list"
  return 0
}

# True if Debian's package of that name is installed.
is_installed() {
  [[ "$(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null)" == installed ]]
}

mapfile -t wanted < <(packages_of "$@")
if [[ ${#wanted[@]} -eq 0 ]]; then
  echo "usage: install-packages.sh GROUP...   (the groups of packages.txt)" >&2
  exit 2
fi

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  echo "There is no apt-get here, so nothing is installed. Needed, under Debian's names:" >&2
  echo "  ${wanted[*]}" >&2
  exit 0
fi

missing=()
for package in "${wanted[@]}"; do
  is_installed "$package" || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $EUID -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "Not installed: ${missing[*]}" >&2
    echo "Run this as root, without sudo here:  apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "== Installing ${missing[*]}"
apt_get() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 "$@" </dev/null
}
install_missing() {
  apt_get install -y --no-install-recommends "${missing[@]}" >/dev/null
}
# The package lists may be absent, or so old that files they name are gone.
if ! apt-cache show "${missing[@]}" >/dev/null 2>&1 || ! install_missing 2>/dev/null; then
  apt_get update
  install_missing
fi
