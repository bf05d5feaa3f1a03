// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "cairn/contact_problem.h"
#include "row_law.h"
#include "simd/pair_block.h"

namespace cairn {

/// Bodies joined by rows: what one lane of a block holds.
struct Pair {
  int a, b;          ///< bodies of the problem; b is kWorld unless both can move
  int row_a, row_b;  ///< bodies of its first row
  int first, rows;   ///< its part of PairList::rows; of a manifold, the number of its rows alone
  simd::PairForm form;
  bool contact;  ///< begins with a row that only pushes: swept after joints
  int shape;     ///< of its rows, in ShapeTable
  int manifold = kNoManifold;

  static constexpr int kNoManifold = -1;
};

/// Where the numbers of rows come from.
enum class RowSource : char { kRows, kManifold };

/// Sequences of row shapes, each once for each source.
class ShapeTable {
 public:
  /// The number of the shape.
  int Intern(std::span<const simd::RowShape> rows, RowSource source);
  std::span<const simd::RowShape> rows(int shape) const;
  /// Lines of all rows of the shape.
  int lines(simd::PairForm form, int shape) const;
  int size() const { return static_cast<int>(begin_.size()) - 1; }
  void Clear();

 private:
  std::vector<simd::RowShape> rows_;
  std::vector<int> begin_ = {0};
  std::vector<RowSource> sources_;
};

/// The structure of a problem: who touches whom, with what kind of rows. No numbers.
struct PairList {
  std::vector<Pair> pairs;  ///< In the order of their first row; manifolds last.
  std::vector<int> rows;    ///< Problem rows, pair by pair, ascending within a pair.

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
using MovableBodies = std::vector<Mobility>;
Mobility MobilityOf(const Body& body);

/// Collects the rows of each pair of bodies. Consecutive rows of the same bodies stay together; a
/// friction row goes with its parent, other rows with earlier ones of the same bodies and kind.
/// Manifolds are a pair each.
class PairFinder {
 public:
  /// Fills the list, and @p shapes as far as new. False if a row has no parent that it may have: an
  /// earlier one of the same bodies, which has none itself.
  /// @pre the manifolds are valid
  [[nodiscard]] bool Find(std::span<const RowLaw> laws, std::span<const Manifold> manifolds,
                          const MovableBodies& movable, ShapeTable* shapes, PairList* list);

 private:
  void AddManifolds(std::span<const Manifold> manifolds, ShapeTable* shapes);
  int ShapeOf(const Manifold& manifold, ShapeTable* shapes);
  int PairOf(const RowLaw& law, size_t index);
  int Look(int a, int b, bool contact);
  void HandOutRows();
  void FindShapes(ShapeTable* shapes);

  std::span<const RowLaw> laws_;
  const MovableBodies* movable_ = nullptr;
  PairList* list_ = nullptr;
  std::vector<int> pair_of_row_;
  std::vector<int> table_;  ///< open addressing: pair + 1, or 0
  std::vector<int> place_;  ///< problem row -> row of its pair
  std::vector<simd::RowShape> scratch_;
};

}  // namespace cairn
