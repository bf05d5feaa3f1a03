// SPDX-License-Identifier: MIT
#include "worlds/campaign.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

namespace cairn::bench {
namespace {

/// Calls `run` for each seed's index on the threads of the options.
template <class RunOne>
void ForEachWorld(const CampaignOptions& options, RunOne run) {
  const size_t count = options.seeds.size();
  std::atomic<size_t> next{0};
  std::mutex mutex;
  size_t done = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    for (size_t i; (i = next++) < count;) {
      try {
        run(i);
        const std::lock_guard lock(mutex);
        ++done;
        if (options.progress) options.progress(done);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::thread> workers;
  for (int i = 1; i < options.jobs; ++i) workers.emplace_back(work);
  work();
  for (std::thread& worker : workers) worker.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

bool WorldResult::failed() const {
  return std::any_of(findings.begin(), findings.end(),
                     [](const std::vector<Finding>& found) { return !found.empty(); });
}

bool AnyFails(std::span<const WorldResult> results, int doubts) {
  int doubtful = 0;
  for (const WorldResult& result : results) {
    for (const std::vector<Finding>& found : result.findings) {
      if (std::ranges::any_of(found, IsProof, &Finding::oracle)) return true;
      doubtful += found.empty() ? 0 : 1;
    }
  }
  return doubtful > doubts;
}

WorldResult RunWorld(const CampaignOptions& options, const WorldSeed& seed) {
  WorldResult result;
  result.seed = seed.seed;
  result.kind = &KindOf(seed.seed);
  TrialOptions trial = options.trial;
  trial.world = seed;
  if (const auto known = options.bullet.find(seed.seed); known != options.bullet.end()) {
    result.bullet = known->second;
  } else {
    for (const Variant& variant : BulletVariants()) {
      result.bullet.push_back(RunTrial(trial, variant));
    }
  }
  for (const Variant& variant : options.variants) {
    result.trials.push_back(RunTrial(trial, variant));
    result.findings.push_back(Judge(result.trials.back(), result.bullet, options.lines));
    const bool fast = std::any_of(result.findings.back().begin(), result.findings.back().end(),
                                  [](const Finding& finding) { return IsOfSpeed(finding.oracle); });
    if (fast && !result.converged) result.converged = RunTrial(trial, ConvergedBullet());
  }
  // files do not tell who may not sleep from who did not
  for (Trial& trial_of_bullet : result.bullet) {
    if (std::isnan(result.trials.front().asleep_at)) {
      trial_of_bullet.asleep_at = result.trials.front().asleep_at;
    }
  }
  return result;
}

std::vector<WorldResult> RunWorlds(const CampaignOptions& options) {
  std::vector<WorldResult> results(options.seeds.size());
  ForEachWorld(options, [&](size_t i) {
    WorldSeed world = options.trial.world;
    world.seed = options.seeds[i];
    results[i] = RunWorld(options, world);
  });
  return results;
}

void CompareBits(const CampaignOptions& options, std::vector<WorldResult>* results) {
  ForEachWorld(options, [&](size_t i) {
    WorldResult& result = (*results)[i];
    TrialOptions trial = options.trial;
    trial.world.seed = options.seeds[i];
    trial.audit_every = 0;
    for (size_t k = 0; k < options.variants.size(); ++k) {
      const Trial again = RunTrial(trial, options.variants[k]);
      const bool known =
          std::any_of(result.findings[k].begin(), result.findings[k].end(),
                      [](const Finding& finding) { return finding.oracle == Oracle::kBits; });
      if (again.hash != result.trials[k].hash && !known) {
        result.findings[k].push_back({Oracle::kBits, 1, 0});
      }
    }
  });
}

}  // namespace cairn::bench
