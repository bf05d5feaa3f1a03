// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "block_frame.h"
#include "budget.h"
#include "memories.h"
#include "pack.h"
#include "subspace/policy.h"

namespace cairn {

/// Subspace steps on islands whose state is in blocks. The step itself works in double precision on
/// rows of its own, packed when the first step of a frame is considered.
class BlockSteps {
 public:
  /// A new frame. The arguments must outlive it.
  void Begin(const ContactProblem& problem, const Settings& settings, BlockFrame* frame,
             IslandMemories* memories);

  /// Whether a step should be tried on the island now; see IslandMemory::StepPays().
  bool Pays(int island, BudgetMeter* meter, double sweep_units);
  /// Takes it. Returns how many factorisations were made, 0 if none succeeded and nothing changed.
  int Take(int island, BudgetMeter* meter);
  /// What became of the step.
  void Judge(int island, bool accepted);

 private:
  struct State {
    IslandMemory* memory = nullptr;
    std::optional<PackedIsland> packed;
  };

  void FindRows();
  State& StateOf(int island);
  void Read(int island, const PackedIsland& packed, IslandState* state) const;
  void Write(int island, const IslandState& state) const;

  const ContactProblem* problem_ = nullptr;
  const Settings* settings_ = nullptr;
  BlockFrame* frame_ = nullptr;
  IslandMemories* memories_ = nullptr;
  std::optional<Packer> packer_;

  int plan_number_ = -1;         ///< of what follows
  std::vector<Island> islands_;  ///< of the plan, with their rows
  std::vector<int> place_;       ///< problem row -> x line * lanes + lane
  std::vector<State> states_;
};

}  // namespace cairn
