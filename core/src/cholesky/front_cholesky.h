// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cairn/detail/memory.h"
#include "cholesky/factor_pattern.h"
#include "cholesky/line_allocator.h"
#include "runtime/crew.h"
#include "runtime/deadline.h"
#include "simd/fronts/front_kernels.h"
#include "simd/target.h"

namespace cairn {

/// Multifrontal Cholesky factor of a sparse symmetric positive definite matrix of dense blocks, in
/// float or double. Same bits on every target and with any number of threads. Allocates in
/// Analyse() only.
template <class T>
class FrontCholesky {
 public:
  explicit FrontCholesky(simd::Target target);

  /// Who factorises: a crew needs more memory.
  enum class Workers { kOne, kCrew };

  /// Finds the pattern of the factor, see FactorPattern, and lays out memory. The matrix is zero
  /// then.
  void Analyse(int nodes, int node_size, std::span<const NodePair> pairs,
               std::span<const int> order = {}, Workers workers = Workers::kCrew);
  const FactorPattern& pattern() const { return pattern_; }

  /// The matrix, which Factorise() leaves as it is: blocks of node_size x node_size numbers,
  /// column-major. The lower triangle of a node with itself, and the block with the rows of the
  /// first node of a pair and the columns of the second.
  T* diagonal(int node) { return ValuesOf(block_of_[node]); }
  T* upper(int pair) { return ValuesOf(block_of_[pattern_.nodes() + pair]); }
  void SetZero();

  /// False if the matrix is not positive definite: if rounding leaves of a pivot no more than that
  /// of its diagonal entry, or if it is not finite. @p crew: has to be announced in Analyse().
  /// @p deadline: where it passes, nothing comes of it.
  [[nodiscard]] bool Factorise(Crew* crew = nullptr, Deadline* deadline = nullptr);

  /// x := matrix^-1 x, node_size numbers for each node in the order of Analyse().
  /// @pre Factorise() succeeded
  void Solve(std::span<T> x, Deadline* deadline = nullptr);

 private:
  using Front = FactorPattern::Front;
  using Numbers = std::vector<T, LineAllocator<T>>;

  /// Where a block of the matrix goes.
  struct Block {
    std::uint64_t to : 63;  ///< in the panel of its front
    std::uint64_t transposed : 1;
  };
  /// Memory of a front.
  struct Place {
    std::size_t panel, update;
    int blocks_begin, blocks_end;
    int runs_begin, runs_end;  ///< of its update in its parent
  };
  /// Subtrees, each a unit, then the fronts above them, each in a few stages.
  class Stages;
  enum class Step { kSubtrees, kBegin, kSquare, kRows, kUpdate, kEnd };
  struct Stage {
    Step step;
    int front;
    int begin, end;  ///< pivots
    int units;
  };

  // front_layout.cc
  void PlaceBlocks(std::span<const NodePair> pairs);
  void PlacePanels();
  void FindRuns();
  void CutTree();
  void FindSubtrees();
  void AddTopStages(int front);
  class Planner;
  std::size_t UpdateSize(int front) const;
  void PlaceUpdate(int front, Planner* planner);
  std::size_t PlaceUpdates();
  std::size_t PlaceUpdatesOfSubtrees();

  /// Rows that are one unit of a stage above the subtrees, a multiple of the padding.
  static constexpr int kRowsOfUnit = 96;
  static int UnitsOf(int rows) { return (rows + kRowsOfUnit - 1) / kRowsOfUnit; }

  T* ValuesOf(std::size_t block) {
    return values_.data() + block * pattern_.node_size() * pattern_.node_size();
  }
  int Scalars(int nodes) const { return nodes * pattern_.node_size(); }
  /// Without memory.
  simd::Front<T> ShapeOf(int front) const;
  simd::Front<T> FrontAt(int front);
  std::span<const simd::RowRun> RunsOf(int front) const {
    const Place& place = places_[front];
    return std::span(runs_).subspan(place.runs_begin, place.runs_end - place.runs_begin);
  }
  /// The panel: matrix and children.
  void Begin(int front);
  template <int kNodeSize>
  void CopyBlocks(int front);
  /// What children leave below the pivots.
  void End(int front);
  bool FactorFront(int front);

  /// Right-hand sides between the caller, the order of elimination and fronts. Node sizes are
  /// constants where they matter; 0 is any.
  template <int kNodeSize>
  class Gather;
  template <int kNodeSize>
  void SolveNodes(std::span<T> x, Deadline* deadline);

  const simd::FrontKernels<T>& kernels_;
  FactorPattern pattern_;

  Array<Block> blocks_;  ///< by front, as their numbers are in values_
  Array<int> block_of_;  ///< of nodes, then of pairs
  Array<Place> places_;  ///< one per front
  Array<simd::RowRun> runs_;
  Array<int> subtree_of_;      ///< of each front; -1 above all
  Array<int> subtree_fronts_;  ///< by subtree
  Array<int> subtree_begin_;   ///< in subtree_fronts_, and its end
  Array<Stage> stages_;

  Numbers values_, panels_, updates_, floors_, ordered_, local_;
};

extern template class FrontCholesky<float>;
extern template class FrontCholesky<double>;

}  // namespace cairn
