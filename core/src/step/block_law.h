// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "simd/pair_block.h"
#include "simd/pair_products.h"
#include "step/row_side.h"

namespace cairn {

/// The side of one row of every lane; see RowSide.
struct SideLine {
  RowSide lane[simd::kLanes] = {};
};

/// What a step wants to know of the lanes of a block.
template <class T>
struct LaneSettings {
  simd::LineOf<T> proximal;         ///< eps of rows with bounds, per lane
  simd::LineOf<T> tolerance;        ///< how close to a bound counts as at the bound [N s]
  simd::LineOf<T> taken;            ///< 1 where the island of the lane is worked on now, else 0
  simd::LineOf<T> proximal_joints;  ///< eps of rows without bounds
};

/// One block in a step: its laws as kernels have them, and the step's own numbers, one line a row.
template <class T>
struct BlockLaw {
  const simd::PairBlock& block;
  const simd::Line* lines;  ///< of the block, its pair lines first
  const LaneSettings<T>& lanes;
  simd::LineOf<T>* x;        ///< impulses
  simd::LineOf<T>* slack;    ///< in: G u; then w = G u + E x - target
  simd::LineOf<T>* weights;  ///< W = 1 / (E + eps d) on free rows, 0 elsewhere
  SideLine* sides;

  /// w from G u.
  void FindSlack() const;
  /// Predicts from the natural map where every row ends, see PredictActiveSet(). @pre FindSlack()
  void Predict() const;
  /// Weights from sides; none in lanes that are not worked on. eps d is the proximal term: the step
  /// minimises the energy plus eps d (x - x_start)^2 / 2, because the free rows of a contact face
  /// are redundant and contradict each other.
  void FindWeights() const;
  /// Rows that are not free go to their bounds, sliding friction to that of the present normal.
  void Fix() const;
  /// Free rows whose impulse left its bounds stay at the bound they crossed, from now on. One bit
  /// for each lane that had one.
  std::uint32_t RemoveViolated() const;
  /// Weights of the joints alone that have no compliance, in lanes that are worked on.
  void FindJointWeights() const;
  /// joints := x of rows that have a weight, 0 elsewhere.
  void CopyWeighted(simd::LineOf<T>* joints) const;
  /// x := 0 where there is a weight.
  void ClearWeighted() const;
  /// d |x| of rows without bounds, the largest of each lane.
  simd::LineOf<T> FindJointSpeeds() const;
  /// x inside its bounds.
  void Project() const;
};

extern template struct BlockLaw<float>;
extern template struct BlockLaw<double>;

}  // namespace cairn
