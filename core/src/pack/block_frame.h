// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/contact_problem.h"
#include "cairn/detail/memory.h"
#include "cairn/report.h"
#include "pack/block_pack.h"
#include "plan/plan.h"
#include "runtime/crew.h"
#include "simd/lane_numbers.h"
#include "simd/pairs/pair_sweep.h"

namespace cairn {

/// A contact problem in blocks, from frame to frame: the plan is kept while the structure of the
/// problem stays, and no memory is asked for unless a frame is larger than all before it.
class BlockFrame {
 public:
  /// Lays out the problem, with u from the start impulses, by a new plan where the last one does
  /// not fit. On kInvalid the input is not valid, on kOutOfRange it may not be: see Validate().
  [[nodiscard]] PackResult Begin(const ContactProblem& problem, double omega,
                                 const Impulses& impulses, Crew* crew);
  /// Whether the results are. What is checked before sweeps leaves little to be found here.
  bool IsFinite() const;
  /// Writes the results.
  void End(const ContactProblem& problem, Crew* crew, const Impulses& impulses,
           std::span<Velocity> velocities) const;

  const Plan& plan() const { return plan_; }
  /// Counts how often the plan was made.
  int plan_number() const { return plan_number_; }
  std::span<const WhitenedBody> bodies() const { return bodies_; }
  /// Some body of the problem has a Body::strain.
  bool strained() const { return strained_; }
  BlockData& blocks() { return blocks_; }
  std::span<simd::BlockError> errors() { return errors_; }
  simd::Target target() const { return target_; }
  const simd::PairKernels& kernels() const { return *kernels_; }
  const simd::LaneKernels& lane_kernels() const { return *lane_kernels_; }
  /// Who works on the frame that has begun.
  Crew* crew() const { return crew_; }

  /// All of a group, or some blocks of a large one.
  simd::PairWork WorkOn(const Group& group, int first_block, int blocks);

 private:
  PackResult WhitenBodies(const ContactProblem& problem, Crew* crew);
  bool MakePlan(const ContactProblem& problem, double omega, std::span<const double> impulses,
                Crew* crew);
  PackResult Pack(const ContactProblem& problem, const Impulses& impulses, Crew* crew);
  bool SameJointsAndManifolds(const ContactProblem& problem, Crew* crew) const;
  void Start(Crew* crew);
  BlockPacker PackerOf(const ContactProblem& problem) const;

  const simd::Target target_ = simd::ChosenTarget();
  const simd::PairKernels* kernels_ = &simd::PairKernelsFor(target_);
  const simd::LaneKernels* lane_kernels_ = &simd::LaneKernelsFor(target_);
  simd::RowPackKernel pack_row_ = simd::RowPackKernelFor(target_);
  simd::JointRowsKernel pack_joints_ = simd::JointRowsKernelFor(target_);
  const simd::ContactKernels* contact_kernels_ = &simd::ContactKernelsFor(target_);
  Crew* crew_ = nullptr;
  Plan plan_;
  Array<RowKind> row_kinds_;
  Array<Joint> planned_joints_;
  Array<Manifold> planned_manifolds_;
  int plan_number_ = 0;
  double omega_ = 1;
  size_t planned_rows_ = 0;
  bool planned_ = false;
  bool strained_ = false, locked_ = false;
  MovableBodies movable_, movable_now_;
  Array<WhitenedBody> bodies_;
  Array<simd::ContactBody> contact_bodies_;
  BlockData blocks_;
  Array<simd::BlockError> errors_;
};

}  // namespace cairn
