// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <span>

namespace cairn {

/// The threads that work on one Solve(). The only user of oneTBB.
class Crew {
 public:
  /// @p threads: the caller included, >= 1. One thread starts no others.
  explicit Crew(int threads);
  ~Crew();
  Crew(Crew&&) noexcept;
  Crew& operator=(Crew&&) noexcept;

  int threads() const;

  /// Runs work(stage, block) for every block of every stage, stage after stage: no block begins
  /// before all of the stage before it are done. Blocks of a stage are claimed by whoever is free,
  /// each once. The caller works along, and finishes alone if no thread comes.
  void Run(std::span<const int> blocks_of_stage, const std::function<void(int, int)>& work);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cairn
