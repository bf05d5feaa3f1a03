// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/detail/memory.h"
#include "pack/block_pack.h"
#include "plan/plan.h"
#include "simd/pairs/pair_active_set.h"
#include "simd/pairs/pair_products.h"
#include "step/block_system.h"
#include "step/step_settings.h"

namespace cairn {

/// What an island brings to a step, and what becomes of it; by island of the plan.
struct IslandStep {
  bool taken = false;                        ///< the island takes it; for others nothing changes
  double proximal = 0, proximal_joints = 0;  ///< see StepSettings
  bool condense_joints = false;              ///< likewise
  int factorisations = 1;                    ///< at most
  StepResult result = {};                    ///< out
};

/// TakeStep() for islands of a group that is in blocks, each as if it were alone, on numbers of its
/// own in float or in double precision.
template <class T>
class BlockStep : public detail::Placed {
 public:
  explicit BlockStep(simd::Target target)
      : products_(simd::PairProductsFor<T>(target)),
        kernels_(simd::ActiveSetKernelsFor<T>(target)) {}

  /// @p refinements: StepSettings::refinements. @p islands: one for each of the plan. An island
  /// whose system could not be factorised stays as it is. Returns how many factorisations were made
  /// in all. @p deadline: where it passes, the step is given up, and nothing changes.
  /// @pre system->IsPreparedFor() this group
  int Take(const Plan& plan, int group, int refinements, BlockSystem<T>* system, Crew* crew,
           BlockData* blocks, std::span<IslandStep> islands, Deadline* deadline = nullptr);

 private:
  using LineT = simd::LineOf<T>;

  /// All but Write(). Returns how many factorisations were made.
  int Find(int refinements, Crew* crew);
  void Read();
  void FindTolerances();
  void Predict();
  /// u as the sweeps left it: floats that x belongs to but for rounding.
  void ReadVelocities();
  void FindRelativeVelocities();
  void Refine();
  void RefineWhileSetHolds(int refinements);
  void Remove();
  /// Brings joints of islands that ask for it to their smallest impulses. Whether there were any.
  bool CondenseJoints(Crew* crew);
  /// Those of rows that have a weight, as they move bodies now.
  void FindSmallest();
  /// out := G_J' x_J of rows that have a weight
  void MultiplyWeighted(Array<T>* out);
  void FindJointSpeeds(double StepResult::*speed);
  void Write();
  /// function(island) for those of the group
  template <class Function>
  void ForIslands(const Function& function);
  bool Any(char phase);
  /// Islands that have had all of their factorisations are done.
  void CloseAfter(int factorisations);
  /// Work is on islands in this phase from now on.
  void WorkOn(char phase);
  /// to := from, in lanes that are worked on.
  template <class Lines>
  void CopyTaken(const Lines& from, Lines* to);

  /// function(set) for every block of the group
  template <class Function>
  void ForBlocks(const Function& function);
  simd::PairActiveSet<T> ActiveSetOf(int block);
  /// v := G' y, by node.
  void MultiplyTransposed(const Array<LineT>& y, Array<T>* v);
  /// y := G v
  void Multiply(const Array<T>& v, Array<LineT>* y);

  const simd::PairProducts<T>& products_;
  const simd::ActiveSetKernels<T>& kernels_;
  const Plan* plan_ = nullptr;
  const Group* group_ = nullptr;
  BlockData* blocks_ = nullptr;
  BlockSystem<T>* system_ = nullptr;
  std::span<IslandStep> islands_;
  Deadline* deadline_ = nullptr;
  bool bounded_ = false, free_ = false;  ///< some row of the group has bounds, some has none
  Array<char> phases_, phases_before_;   ///< by island

  Array<simd::LaneSettings<T>> lanes_;  ///< by block
  Array<LineT> x_, start_, before_, w_, weights_, product_;
  Array<LineT> of_blocks_;  ///< see RunResults
  Array<simd::SideLine> sides_, sides_before_;
  Array<T> u_, du_, wanted_;  ///< six numbers a node
  Array<double> sums_, counts_;
};

extern template class BlockStep<float>;
extern template class BlockStep<double>;

}  // namespace cairn
