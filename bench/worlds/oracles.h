// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "worlds/trial.h"

namespace cairn::bench {

/// What a solver may fail at in a world.
enum class Oracle { kFliesApart, kAudit, kRestless, kGap, kPenetration, kMomentum, kBits };
inline constexpr int kOracles = 7;
/// "flies apart", "audit", ...
std::string_view NameOf(Oracle oracle);

/// Whether it fails where bodies are too fast.
inline bool IsOfSpeed(Oracle oracle) {
  return oracle == Oracle::kFliesApart || oracle == Oracle::kRestless;
}

/// Whether a single failure proves something. The other lines are far from what solvers differ by,
/// but worlds are chaotic: a pin between boxes that others wedge apart opens, whoever solves.
inline bool IsProof(Oracle oracle) {
  return oracle != Oracle::kRestless && oracle != Oracle::kGap && oracle != Oracle::kPenetration;
}

/// Where oracles draw the line. A world that is chaotic ends differently with every solver: lines
/// are far from what solvers differ by.
struct Lines {
  double fast = Trial::kTooFast;     ///< Flies apart: faster than this [m/s] and
  double fast_factor = 2;            ///< than this times the fastest of every run of Bullet.
  double restless = 3, resting = 1;  ///< Fastest in the last quarter; Bullet's below [m/s].
  /// The largest gap of the run above this many times the largest of Bullet with 10 iterations and
  /// with the world's, and this [m] more. Penetration likewise.
  double gap_factor = 3, gap_more = 0.1;
  double penetration_factor = 3, penetration_more = 0.1;
  /// Relative drift of momentum above this and above this many times Bullet's.
  double drift = 1e-3, drift_factor = 3;
};

struct Finding {
  Oracle oracle;
  double value, line;  ///< In the oracle's unit: above the line is a failure.
};

/// What is wrong with a run, measured against those of Bullet, in the order of BulletVariants().
std::vector<Finding> Judge(const Trial& trial, std::span<const Trial> bullet,
                           const Lines& lines = {});

/// Whether Bullet with 10 iterations is restless where it rests with 100, by the same lines.
bool IsBulletRestless(std::span<const Trial> bullet, const Lines& lines = {});
/// Whether any run of Bullet flies apart.
bool DoesBulletFlyApart(std::span<const Trial> bullet, const Lines& lines = {});

}  // namespace cairn::bench
