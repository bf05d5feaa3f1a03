// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "worlds/oracles.h"

namespace cairn::bench {

/// One world with every solver.
struct WorldResult {
  std::uint64_t seed = 0;
  const Kind* kind = nullptr;
  std::vector<Trial> bullet;                   ///< In the order of BulletVariants().
  std::vector<Trial> trials;                   ///< In the order of the variants asked for.
  std::vector<std::vector<Finding>> findings;  ///< Of each trial.
  /// ConvergedBullet(), where a trial is faster than an oracle allows.
  std::optional<Trial> converged;

  bool failed() const;
};

/// Whether some oracle proves a failure, see IsProof(), or the others fail more than @p doubts
/// times.
bool AnyFails(std::span<const WorldResult> results, int doubts);

/// What became of worlds with Bullet, by seed, in the order of BulletVariants().
using BulletRuns = std::unordered_map<std::uint64_t, std::vector<Trial>>;

struct CampaignOptions {
  std::vector<std::uint64_t> seeds;
  std::vector<Variant> variants;
  TrialOptions trial;  ///< The seed is set for each world.
  Lines lines;
  BulletRuns bullet;  ///< Known from before, of the same worlds; others are run.
  int jobs = 1;       ///< Threads, each with worlds of its own.
  /// Called with the number of worlds that are done, by one thread at a time.
  std::function<void(size_t)> progress;
};

/// Runs the worlds; the results do not depend on the number of jobs.
std::vector<WorldResult> RunWorlds(const CampaignOptions& options);

/// One world. @param seed  instead of that of the options
WorldResult RunWorld(const CampaignOptions& options, const WorldSeed& seed);

/// Runs the same worlds with the variants again, and adds a finding where one does not end with the
/// bits of its result. @pre the results are those of the options, but for what must not matter:
/// threads, instruction set.
void CompareBits(const CampaignOptions& options, std::vector<WorldResult>* results);

}  // namespace cairn::bench
