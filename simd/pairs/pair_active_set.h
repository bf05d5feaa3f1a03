// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "simd/pairs/pair_block.h"
#include "simd/pairs/pair_products.h"
#include "simd/target.h"

namespace cairn::simd {

/// Where a row is predicted to end: strictly between its bounds, or at one of them. A friction row
/// at a bound slides, and the bound follows the impulse of its parent. As wide as a float, so that
/// lanes of both fit the same registers.
enum class RowSide : std::int32_t { kFree, kLo, kHi };

/// The side of one row of every lane.
struct alignas(64) SideLine {
  RowSide lane[kLanes] = {};
};

/// What a step wants to know of the lanes of a block.
template <class T>
struct LaneSettings {
  LineOf<T> proximal;         ///< eps of rows with bounds, per lane
  LineOf<T> tolerance;        ///< how close to a bound counts as at the bound [N s]
  LineOf<T> taken;            ///< 1 where the island of the lane is worked on now, else 0
  LineOf<T> proximal_joints;  ///< eps of rows without bounds
};

/// One block in a step: its rows as kernels have them, and the step's own numbers, one line a row.
template <class T>
struct PairActiveSet {
  const PairBlock& block;
  const Line* lines;  ///< of the block, its pair lines first
  const LaneSettings<T>& lanes;
  LineOf<T>* x;        ///< impulses
  LineOf<T>* w;        ///< in: G u; then w = G u + E x - target
  LineOf<T>* weights;  ///< W = 1 / (E + eps d) on free rows, 0 elsewhere
  LineOf<T>* product;  ///< room for a product
  SideLine* sides;
};

/// What a subspace step does with the rows of a block, in T. Same bits on every target.
template <class T>
struct ActiveSetKernels {
  using Kernel = void (*)(const PairActiveSet<T>& set);

  /// w from G u.
  Kernel find_relative_velocities;
  /// Predicts from the natural map where every row ends, see PredictActiveSet(). @pre
  /// find_relative_velocities
  Kernel predict;
  /// Weights from sides; none in lanes that are not worked on. eps d is the proximal term: the step
  /// minimises the energy plus eps d (x - x_start)^2 / 2, because the free rows of a contact face
  /// are redundant and contradict each other.
  Kernel find_weights;
  /// Rows that are not free go to their bounds, sliding friction to that of the present normal.
  Kernel fix;
  /// Free rows whose impulse left its bounds stay at the bound they crossed, from now on. One bit
  /// for each lane that had one.
  std::uint32_t (*remove_violated)(const PairActiveSet<T>& set);
  /// product := -W w
  Kernel weigh;
  /// x := x - W (w + product)
  Kernel advance;
  /// Weights of the joints alone that have no compliance, in lanes that are worked on.
  Kernel find_joint_weights;
  /// product := x of rows that have a weight, 0 elsewhere.
  Kernel copy_weighted;
  /// x := 0 where there is a weight.
  Kernel clear_weighted;
  /// d |x| of rows without bounds, the largest of each lane.
  LineOf<T> (*find_joint_speeds)(const PairActiveSet<T>& set);
  /// x inside its bounds.
  Kernel project;
};

/// @pre the CPU supports it
template <class T>
const ActiveSetKernels<T>& ActiveSetKernelsFor(Target target);
template <>
const ActiveSetKernels<float>& ActiveSetKernelsFor(Target target);
template <>
const ActiveSetKernels<double>& ActiveSetKernelsFor(Target target);

}  // namespace cairn::simd
