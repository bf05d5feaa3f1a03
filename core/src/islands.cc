// SPDX-License-Identifier: MIT
#include "islands.h"

#include <algorithm>
#include <numeric>

namespace cairn {
namespace {

/// Union-find in which the root of a set is its smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int Root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void Join(int i, int j) {
    i = Root(i);
    j = Root(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace

bool CanMove(const Body& body) {
  return (body.inv_mass > 0 && !body.linear_factor.isZero(0)) || !body.inv_inertia.isZero(0);
}

std::vector<Island> FindIslands(const ContactProblem& problem) {
  std::vector<char> can_move;
  can_move.reserve(problem.bodies.size());
  for (const Body& body : problem.bodies) can_move.push_back(CanMove(body));
  const auto movable = [&can_move](int body) { return body != kWorld && can_move[body] != 0; };

  // join bodies that share a row, and mark the bodies that have rows at all
  DisjointSets sets(problem.bodies.size());
  std::vector<bool> has_row(problem.bodies.size(), false);
  for (const Row& row : problem.rows) {
    const bool a = movable(row.body_a), b = movable(row.body_b);
    if (a && b) sets.Join(row.body_a, row.body_b);
    if (a) has_row[row.body_a] = true;
    if (b) has_row[row.body_b] = true;
  }

  // number the sets by their smallest body
  std::vector<Island> islands;
  std::vector<int> island_of(problem.bodies.size(), -1);
  for (int body = 0; body < static_cast<int>(problem.bodies.size()); ++body) {
    if (!has_row[body]) continue;
    const int root = sets.Root(body);
    if (island_of[root] < 0) {
      island_of[root] = static_cast<int>(islands.size());
      islands.emplace_back();
    }
    island_of[body] = island_of[root];
    islands[island_of[body]].bodies.push_back(body);
  }

  // hand out the rows
  Island unattached;
  for (int r = 0; r < static_cast<int>(problem.rows.size()); ++r) {
    const Row& row = problem.rows[r];
    const int body = movable(row.body_a) ? row.body_a : row.body_b;
    (movable(body) ? islands[island_of[body]] : unattached).rows.push_back(r);
  }
  if (!unattached.rows.empty()) islands.push_back(std::move(unattached));
  return islands;
}

}  // namespace cairn
