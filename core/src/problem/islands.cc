// SPDX-License-Identifier: MIT
#include "problem/islands.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "cairn/detail/eigen.h"

namespace cairn {

bool CanMove(const Body& body) {
  return (body.inv_mass > 0 && !View(body.linear_factor).isZero(0)) ||
         !View(body.inv_inertia).isZero(0);
}

void IslandFinder::Start(int bodies) {
  parent_.resize(bodies);
  std::iota(parent_.begin(), parent_.end(), 0);
  island_.assign(bodies, -1);
}

int IslandFinder::Root(int body) {
  while (parent_[body] != body) body = parent_[body] = parent_[parent_[body]];
  return body;
}

void IslandFinder::Join(int a, int b) {
  if (a != kWorld) island_[a] = 0;
  if (b != kWorld) island_[b] = 0;
  if (a == kWorld || b == kWorld) return;
  a = Root(a);
  b = Root(b);
  parent_[std::max(a, b)] = std::min(a, b);
}

int IslandFinder::Number() {
  int count = 0;
  for (int body = 0; body < static_cast<int>(parent_.size()); ++body) {
    if (island_[body] < 0) continue;
    const int root = Root(body);
    island_[body] = root == body ? count++ : island_[root];
  }
  return count;
}

Array<Island> FindIslands(const ContactProblem& problem) {
  Array<char> can_move;
  can_move.reserve(problem.bodies.size());
  for (const Body& body : problem.bodies) can_move.push_back(CanMove(body));
  const auto movable = [&can_move](int body) {
    return body != kWorld && can_move[body] != 0 ? body : kWorld;
  };

  IslandFinder finder;
  finder.Start(static_cast<int>(problem.bodies.size()));
  for (const Row& row : problem.rows) finder.Join(movable(row.body_a), movable(row.body_b));
  Array<Island> islands(finder.Number());
  const Array<int>& island_of = finder.island_of_body();
  for (int body = 0; body < static_cast<int>(problem.bodies.size()); ++body) {
    if (island_of[body] >= 0) islands[island_of[body]].bodies.push_back(body);
  }

  // hand out the rows
  Island unattached;
  for (int r = 0; r < static_cast<int>(problem.rows.size()); ++r) {
    const Row& row = problem.rows[r];
    const int body = std::max(movable(row.body_a), movable(row.body_b));
    (body != kWorld ? islands[island_of[body]] : unattached).rows.push_back(r);
  }
  if (!unattached.rows.empty()) islands.push_back(std::move(unattached));
  return islands;
}

}  // namespace cairn
