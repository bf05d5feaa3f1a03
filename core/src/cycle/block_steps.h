// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pack/block_frame.h"
#include "runtime/budget.h"
#include "runtime/crew.h"
#include "step/block_step.h"
#include "step/island_memories.h"

namespace cairn {

/// Subspace steps on islands whose state is in blocks: those of a group together, as their rows
/// share lanes. In single precision on islands whose rows all have bounds, as those of contacts;
/// rows without want a proximal term that floats cannot hold.
class BlockSteps {
 public:
  /// A new frame. The arguments must outlive it. @p asked: steps may be taken
  void Begin(const ContactProblem& problem, const Settings& settings, BlockFrame* frame,
             IslandMemories* memories, BudgetMeter* meter, Crew* crew, bool asked);

  /// Steps may be taken at all.
  bool asked() const { return asked_; }
  /// Whether no step failed on the island of late.
  bool Due(int island);
  /// What a step with one factorisation is thought to cost on some islands of a group, in
  /// relaxations of rows by kernels, before their graph is looked at; 0 if it is known.
  double Guess(int group, std::span<const int> islands);
  /// What the analysis of a graph costs, and a step's share of it: it serves those on later frames,
  /// too. Zeros if none is needed.
  struct AnalysisPrice {
    double whole = 0, of_step = 0;
  };
  AnalysisPrice PriceOfAnalysis(int group, std::span<const int> islands);
  void Analyse(int group, std::span<const int> islands);
  /// What a step with so many factorisations costs. @pre no analysis is needed
  double Price(int group, std::span<const int> islands, int factorisations);
  /// The island is left alone for a while: steps are too dear there.
  void Postpone(int island) { MemoryOf(island)->Postpone(); }
  /// What steps and sweeps were seen to gain on the island.
  StepOdds& odds(int island) { return MemoryOf(island)->odds(); }
  /// How many factorisations the next step of a group may make.
  void Limit(int group, int factorisations) { limits_[group] = factorisations; }
  /// Takes a step on some islands of a group.
  void Take(int group, std::span<const int> islands);
  /// What came of the last one; where it did not succeed, nothing changed.
  const StepResult& result(int island) const { return islands_[island].result; }
  /// What was charged for it: its share of the group's, by rows.
  double work(int island) const { return work_[island]; }
  /// A guard undid something on the island.
  void Guarded(int island) { MemoryOf(island)->Guarded(); }
  /// What became of the step.
  void Judge(int island, bool accepted);

 private:
  struct Precisions {
    bool some_double, all_double;
  };
  Precisions PrecisionsOf(std::span<const int> islands) const;
  IslandMemory* MemoryOf(int island);
  void ReadPlan();
  template <class T>
  BlockSystem<T>& SystemOf(int group);
  /// function(system) for each that the islands need.
  template <class Function>
  void ForSystems(int group, std::span<const int> islands, const Function& function);
  template <class T>
  double PriceOf(int group, int factorisations);
  template <class T>
  void TakeAs(int group, std::span<const int> islands, BlockStep<T>* step);

  const ContactProblem* problem_ = nullptr;
  const Settings* settings_ = nullptr;
  BlockFrame* frame_ = nullptr;
  IslandMemories* memories_ = nullptr;
  BudgetMeter* meter_ = nullptr;
  Crew* crew_ = nullptr;
  bool asked_ = false;
  bool has_budget_ = false;

  int plan_number_ = -1;             ///< of what follows
  std::vector<int> limits_;          ///< by group
  std::vector<char> in_double_;      ///< by island
  std::vector<std::uint64_t> keys_;  ///< by island
  std::vector<IslandMemory*> memory_of_island_;
  std::vector<IslandStep> islands_, islands_now_;
  std::vector<double> work_;  ///< by island
  std::unique_ptr<BlockStep<float>> float_step_;
  std::unique_ptr<BlockStep<double>> double_step_;
};

}  // namespace cairn
