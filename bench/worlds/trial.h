// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "worlds/merit.h"
#include "worlds/random_world.h"
#include "worlds/variants.h"

namespace cairn::bench {

/// How a world is run.
struct TrialOptions {
  WorldSeed world;
  double seconds = 5;
  int audit_every = 10;  ///< Substeps; 0: never.
  /// Of Cairn; results must not depend on it.
  int threads = 1;
  /// Where the problem of a frame goes, empty for nowhere.
  std::string record_path;
  int record_frame = -1;
};

/// What became of a world with one solver.
struct Trial {
  int bodies = 0, joints = 0;  ///< At the end.
  int frames = 0;              ///< Made; fewer than asked for if the world flew apart.
  /// The first in which a body was faster than kTooFast, -1 if there is none.
  int wild_frame = -1;
  double fastest = 0;       ///< Of all bodies, in the whole run [m/s]; NaN if a speed was.
  double late_fastest = 0;  ///< In the last quarter.
  double gap = 0;           ///< The largest joint gap of the run [m].
  double penetration = 0;   ///< The deepest of the run [m].
  double energy = 0;        ///< At the end [J].
  std::int64_t steps_kept = 0, steps_undone = 0;
  int audits = 0, audits_violated = 0;
  Audit worst_audit;
  int worst_frame = -1;  ///< Of worst_audit.
  /// When the last body fell asleep, infinity if not all did, NaN if none may [s].
  double asleep_at = std::numeric_limits<double>::quiet_NaN();
  double linear_drift = 0, angular_drift = 0;  ///< Of kinds that float; see MomentumWatch.
  std::uint64_t hash = 0;                      ///< StateHash() at the end.
  double cpu_seconds = 0;

  /// A body faster than this is not falling, driving or thrown [m/s].
  static constexpr double kTooFast = 60;
  /// At ten times that the rest of the run says nothing any more.
  static constexpr double kHopeless = 600;
};

Trial RunTrial(const TrialOptions& options, const Variant& variant);

}  // namespace cairn::bench
