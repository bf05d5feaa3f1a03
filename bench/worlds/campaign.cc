// SPDX-License-Identifier: MIT
#include "worlds/campaign.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace cairn::bench {

bool WorldResult::failed() const {
  return std::any_of(findings.begin(), findings.end(),
                     [](const std::vector<Finding>& found) { return !found.empty(); });
}

WorldResult RunWorld(const CampaignOptions& options, const WorldSeed& seed) {
  WorldResult result;
  result.seed = seed.seed;
  result.kind = &KindOf(seed.seed);
  TrialOptions trial = options.trial;
  trial.world = seed;
  for (const Variant& variant : Yardsticks()) result.bullet.push_back(RunTrial(trial, variant));
  for (const Variant& variant : options.variants) {
    result.trials.push_back(RunTrial(trial, variant));
    result.findings.push_back(Judge(result.trials.back(), result.bullet, options.lines));
  }
  return result;
}

std::vector<WorldResult> RunWorlds(const CampaignOptions& options) {
  std::vector<WorldResult> results(options.seeds.size());
  std::atomic<size_t> next{0};
  std::mutex mutex;
  size_t done = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    for (size_t i; (i = next++) < results.size();) {
      try {
        results[i] = RunWorld(options, {options.seeds[i], options.trial.world.scale});
        const std::lock_guard lock(mutex);
        ++done;
        if (options.progress) options.progress(done);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = results.size();
      }
    }
  };
  std::vector<std::thread> workers;
  for (int i = 1; i < options.jobs; ++i) workers.emplace_back(work);
  work();
  for (std::thread& worker : workers) worker.join();
  if (failure) std::rethrow_exception(failure);
  return results;
}

}  // namespace cairn::bench
