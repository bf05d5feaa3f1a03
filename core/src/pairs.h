// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cairn/contact_problem.h"
#include "cairn/settings.h"
#include "simd/pair_block.h"

namespace cairn {

/// Bodies joined by rows: what one lane of a block holds.
struct Pair {
  int a, b;          ///< bodies of the problem; b is kWorld unless both can move
  int row_a, row_b;  ///< bodies of its first row
  int first, rows;   ///< its part of PairList::rows
  simd::PairForm form;
  bool contact;  ///< begins with a row that only pushes: swept after joints
  int shape;     ///< of its rows, in ShapeTable
};

/// Sequences of row shapes, each once.
class ShapeTable {
 public:
  /// The number of the shape.
  int Intern(std::span<const simd::RowShape> rows);
  std::span<const simd::RowShape> rows(int shape) const;
  /// Lines of all rows of the shape.
  int lines(simd::PairForm form, int shape) const;
  int size() const { return static_cast<int>(begin_.size()) - 1; }
  void Clear();

 private:
  std::vector<simd::RowShape> rows_;
  std::vector<int> begin_ = {0};
};

/// The structure of a problem: who touches whom, with what kind of rows. No numbers.
struct PairList {
  std::vector<Pair> pairs;  ///< In the order of their first row.
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

/// The law of a row as a kernel sees it, without the parent. @p omega: Settings::omega of kPsor, or
/// 1.
simd::RowShape ShapeOf(const Row& row, double omega);

/// Whether it still has that law, the parent apart.
bool HasShape(const Row& row, double omega, const simd::RowShape& shape);

/// Whether a row acts on its bodies with opposite forces.
inline bool ActsOpposite(const Row& row) {
  return row.linear_a.x() == -row.linear_b.x() && row.linear_a.y() == -row.linear_b.y() &&
         row.linear_a.z() == -row.linear_b.z();
}

/// Collects the rows of each pair of bodies. Consecutive rows of the same bodies stay together; a
/// friction row goes with its parent, other rows with earlier ones of the same bodies and kind.
class PairFinder {
 public:
  /// Fills list(), and @p shapes as far as new. False if a row is not valid, by ValidateRow().
  /// @pre the bodies are valid
  [[nodiscard]] bool Find(const ContactProblem& problem, std::span<const double> impulses,
                          const MovableBodies& movable, double omega, ShapeTable* shapes);
  const PairList& list() const { return list_; }

 private:
  int PairOf(const Row& row, int index);
  int Look(int a, int b, bool contact);
  void HandOutRows();
  void FindShapes(ShapeTable* shapes);

  const MovableBodies* movable_ = nullptr;
  PairList list_;
  std::vector<int> pair_of_row_;
  std::vector<int> table_;  ///< open addressing: pair + 1, or 0
  std::vector<int> place_;  ///< problem row -> row of its pair
  std::vector<int> parent_;
  std::vector<simd::RowShape> row_shapes_;
  std::vector<simd::RowShape> scratch_;
};

}  // namespace cairn
