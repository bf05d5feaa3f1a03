#!/usr/bin/env bash
# Installs what the window needs, builds it, and opens it: worlds side by side, Bullet and Cairn.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/usage.sh" "$@" <<'TEXT'
usage: bash bench/play.sh [SCENE] [OPTIONS OF cairn play...]

For example:  bash bench/play.sh bridge
              bash bench/play.sh castle --frames 120 --screenshot castle.png
Without a screen it draws on one that nobody sees (Xvfb, with OpenGL in software).
TEXT

under=()
if [[ -z "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]]; then
  if [[ " $* " != *" --frames"* && " $* " != *" --commands"* ]]; then
    echo "There is no screen here: say how far with --frames N, and --screenshot FILE or --video DIR" >&2
    exit 2
  fi
  under=(xvfb-run -a -s "-screen 0 1920x1200x24")
fi

bash "$root/bench/build-tool.sh" build play import
cmake --build "$root/build/release" -j "$(nproc)" --target cairn_play_window

play=("$root/build/release/bin/cairn" play "$@")
echo "== ${play[*]##*/}"
exec "${under[@]}" "${play[@]}"
