// SPDX-License-Identifier: MIT
#include "reference/body_system.h"

#include <algorithm>

namespace cairn {
namespace {

using MappedVector6 = Eigen::Map<const Vector6d>;

/// The movable bodies of a row, counted from 0. @pre both are movable
BodyPair PairOf(const PackedRow& row) { return std::minmax(row.a, row.b); }

bool JoinsTwo(const PackedRow& row) { return row.a != 0 && row.b != 0; }

Array<BodyPair> FindPairs(const PackedIsland& island) {
  Array<BodyPair> pairs;
  for (const PackedRow& row : island.rows) {
    if (!JoinsTwo(row)) continue;
    if (pairs.empty() || pairs.back() != PairOf(row)) pairs.push_back(PairOf(row));
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (auto& [first, second] : pairs) {
    --first;
    --second;
  }
  return pairs;
}

}  // namespace

void BodySystem::Prepare(const PackedIsland& island) {
  Array<BodyPair> pairs = FindPairs(island);
  if (island.bodies != bodies_ || pairs != pairs_) {
    bodies_ = island.bodies;
    pairs_ = std::move(pairs);
    factor_.Analyse(bodies_, pairs_);
  }

  pair_of_row_.assign(island.rows.size(), -1);
  for (size_t i = 0; i < island.rows.size(); ++i) {
    const PackedRow& row = island.rows[i];
    if (!JoinsTwo(row)) continue;
    const bool as_before =
        i > 0 && JoinsTwo(island.rows[i - 1]) && PairOf(island.rows[i - 1]) == PairOf(row);
    const auto [first, second] = PairOf(row);
    pair_of_row_[i] = as_before
                          ? pair_of_row_[i - 1]
                          : static_cast<int>(std::lower_bound(pairs_.begin(), pairs_.end(),
                                                              BodyPair(first - 1, second - 1)) -
                                             pairs_.begin());
  }
}

bool BodySystem::Factorise(const PackedIsland& island, std::span<const double> weights) {
  factor_.SetZero();
  for (int body = 0; body < bodies_; ++body) factor_.diagonal(body).diagonal().setOnes();

  for (size_t i = 0; i < island.rows.size(); ++i) {
    if (weights[i] == 0) continue;
    const PackedRow& row = island.rows[i];
    const MappedVector6 g_a(row.g_a.data()), g_b(row.g_b.data());
    const Vector6d weighted_a = weights[i] * g_a, weighted_b = weights[i] * g_b;
    if (row.a != 0) factor_.diagonal(row.a - 1).noalias() += weighted_a * g_a.transpose();
    if (row.b != 0) factor_.diagonal(row.b - 1).noalias() += weighted_b * g_b.transpose();
    if (pair_of_row_[i] < 0) continue;
    if (row.a < row.b) {
      factor_.upper(pair_of_row_[i]).noalias() += weighted_a * g_b.transpose();
    } else {
      factor_.upper(pair_of_row_[i]).noalias() += weighted_b * g_a.transpose();
    }
  }
  return factor_.Factorise();
}

}  // namespace cairn
