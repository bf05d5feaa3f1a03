// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/contact_problem.h"
#include "simd/pairs/pair_block.h"

namespace cairn {

/// What the plan wants to know of a row: a fifth of its size, and no number that a kernel reads.
struct RowKind {
  int a, b;              ///< bodies, as in the row
  int parent;            ///< as in the row
  bool opposite;         ///< see ActsOpposite()
  simd::RowShape shape;  ///< without the parent
};

/// False if a number is not valid; the parent can only be judged with all rows at hand.
/// @p omega: Tuning::omega of kPsor, or 1.
bool ReadKind(const ContactProblem& problem, int row, double impulse, double omega, RowKind* kind);

/// The kind of a row as a kernel sees it, without the parent.
simd::RowShape ShapeOf(const Row& row, double omega);

/// Whether it still is of that kind, the parent apart.
bool HasShape(const Row& row, double omega, const simd::RowShape& shape);

/// Its bounds, compliance, friction and relaxation may be used.
bool HasValidKind(const Row& row);

/// Whether a row acts on its bodies with opposite forces.
inline bool ActsOpposite(const Row& row) {
  return row.linear_a.x() == -row.linear_b.x() && row.linear_a.y() == -row.linear_b.y() &&
         row.linear_a.z() == -row.linear_b.z();
}

}  // namespace cairn
