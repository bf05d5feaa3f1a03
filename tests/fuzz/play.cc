// SPDX-License-Identifier: MIT
#include "tests/fuzz/play.h"

#include "simd/target.h"
#include "tests/simd/ask_for.h"

namespace cairn::test {

std::string PlayEverywhere(PlayGameOnce play_once, std::span<const std::uint8_t> bytes) {
  std::uint64_t hash = 0;
  int threads = 0;
  for (const simd::Target target : simd::SupportedTargets()) {
    const AskFor restore(target);
    const Play play{std::string(simd::TargetName(target)), 1 + threads++ % 3};
    const GameResult result = play_once(bytes, play);
    if (!result.broken.empty()) return result.broken + ", " + play.simd;
    if (threads > 1 && result.hash != hash) return "other bits on " + play.simd;
    hash = result.hash;
  }
  return "";
}

}  // namespace cairn::test
