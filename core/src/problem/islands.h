// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/contact_problem.h"
#include "cairn/detail/memory.h"

namespace cairn {

/// Bodies connected by rows, and those rows in the order of the problem. Bodies that cannot move
/// connect nothing and belong to no island.
struct Island {
  Array<int> bodies;  ///< ascending problem indices
  Array<int> rows;    ///< ascending problem indices
};

bool CanMove(const Body& body);

/// Which bodies belong together: union-find, in which the root of a set is its smallest member.
class IslandFinder {
 public:
  /// Nothing belongs together yet, and no body to an island.
  void Start(int bodies);
  /// A row between two movable bodies; kWorld for one that cannot move.
  void Join(int a, int b);
  /// Numbers the islands by their first body. Returns how many there are.
  int Number();
  /// -1 for a body without rows. @pre Number()
  const Array<int>& island_of_body() const { return island_; }

 private:
  int Root(int body);

  Array<int> parent_;
  Array<int> island_;  ///< before Number(): 0 where a body has rows, else -1
};

/// Ordered by their first body. Rows without a movable body form a last island without bodies.
Array<Island> FindIslands(const ContactProblem& problem);

}  // namespace cairn
