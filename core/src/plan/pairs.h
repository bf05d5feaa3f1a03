// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/contact_problem.h"
#include "cairn/detail/memory.h"
#include "plan/row_kind.h"
#include "runtime/crew.h"
#include "simd/pairs/pair_block.h"

namespace cairn {

/// Where the numbers of rows come from.
enum class RowSource : char { kRows, kJoint, kManifold };

/// As many pairs one thread looks at at a time.
inline constexpr int kPairsOfPart = 512;

/// Bodies joined by rows: what one lane of a block holds.
struct Pair {
  int a, b;          ///< bodies of the problem; b is kWorld unless both can move
  int row_a, row_b;  ///< bodies of its first row
  int first, rows;   ///< its part of PairList::rows; otherwise, the number of its rows alone
  simd::PairForm form;
  bool contact;  ///< begins with a row that only pushes: swept after joints
  int shape;     ///< of its rows, in ShapeTable
  RowSource source = RowSource::kRows;
  int index = 0;  ///< which of the joints or manifolds it is
};

/// Whether rows of the one are of the same kind and number as those of the other.
inline bool IsOfKindOf(const Joint& a, const Joint& b) {
  return a.rows == b.rows && a.bounded == b.bounded && a.angular == b.angular && a.soft == b.soft &&
         a.opposite == b.opposite && a.host.max_sweeps == b.host.max_sweeps;
}
inline bool IsOfKindOf(const Manifold& a, const Manifold& b) {
  return a.points == b.points && a.tangents == b.tangents && a.soft == b.soft &&
         a.twists == b.twists && a.host.max_sweeps == b.host.max_sweeps;
}

/// Sequences of row shapes, each once for each source.
class ShapeTable {
 public:
  /// The number of the shape.
  int Intern(std::span<const simd::RowShape> rows, RowSource source);
  /// The number of a shape that is there, or -1.
  int Find(std::span<const simd::RowShape> rows, RowSource source) const;
  std::span<const simd::RowShape> rows(int shape) const;
  /// Lines of all rows of the shape.
  int lines(simd::PairForm form, int shape) const;
  int size() const { return static_cast<int>(begin_.size()) - 1; }
  void Clear();

 private:
  Array<simd::RowShape> rows_;
  Array<int> begin_ = {0};
  Array<RowSource> sources_;
};

/// The structure of a problem: who touches whom, with what kind of rows. No numbers.
struct PairList {
  Array<Pair> pairs;  ///< In the order of their first row; then joints, then manifolds.
  Array<int> rows;    ///< Problem rows, pair by pair, ascending within a pair.

  std::span<const int> rows_of(const Pair& pair) const {
    return {rows.data() + pair.first, static_cast<size_t>(pair.rows)};
  }
};

/// How rows can move each body: what the plan knows of it.
enum Mobility : char {
  kUnmoved,  ///< Not at all; see CanMove().
  kMoved,
  kMovedEvenly,  ///< And pushed the same way in all directions.
};
using MovableBodies = Array<Mobility>;
Mobility MobilityOf(const Body& body);

/// Collects the rows of each pair of bodies. Consecutive rows of the same bodies stay together; a
/// friction row goes with its parent, other rows with earlier ones of the same bodies and kind.
/// Joints and manifolds are a pair each.
class PairFinder {
 public:
  /// Fills the list, and @p shapes as far as new. False if a row has no parent that it may have: an
  /// earlier one of the same bodies, which has none itself.
  /// @pre joints and manifolds are valid
  [[nodiscard]] bool Find(std::span<const RowKind> kinds, const ContactProblem& problem,
                          const MovableBodies& movable, Crew* crew, ShapeTable* shapes,
                          PairList* list);

 private:
  /// False as Find().
  bool AddRows(std::span<const RowKind> kinds);
  /// Those of all joints or manifolds, from place @p first of the list on.
  template <class Source>
  void AddAll(std::span<const Source> sources, size_t first, Crew* crew, ShapeTable* shapes);
  /// The pair that a joint or a manifold is. @p opposite: its rows push with opposite forces
  void Put(const Pair& pair, bool opposite, size_t place);
  int PairOf(const RowKind& kind, size_t index);
  int Look(int a, int b, bool contact);
  void HandOutRows();
  void FindShapes(ShapeTable* shapes);

  std::span<const RowKind> row_kinds_;
  const MovableBodies* movable_ = nullptr;
  PairList* list_ = nullptr;
  Array<int> pair_of_row_;
  Array<int> table_;  ///< open addressing: pair + 1, or 0
  Array<int> place_;  ///< problem row -> row of its pair
  Array<simd::RowShape> scratch_;
};

}  // namespace cairn
