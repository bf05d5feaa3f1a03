// SPDX-License-Identifier: MIT
// The block factor against the dense one of Eigen.
#include "cholesky/cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <set>
#include <vector>

#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using Pairs = std::vector<BodyPair>;

Block6 RandomBlock(test::Random* random) {
  Block6 block;
  for (int i = 0; i < 36; ++i) block.data()[i] = random->Uniform(-1, 1);
  return block;
}

/// A random matrix of that pattern; @p diagonal is added to make it positive definite, or not.
Eigen::MatrixXd Fill(BlockCholesky* factor, int bodies, const Pairs& pairs, double diagonal,
                     std::uint64_t seed) {
  test::Random random(seed);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(6 * bodies, 6 * bodies);
  for (int i = 0; i < bodies; ++i) {
    const Block6 root = RandomBlock(&random);
    factor->diagonal(i) = root * root.transpose() + diagonal * Block6::Identity();
    dense.block<6, 6>(6 * i, 6 * i) = factor->diagonal(i);
  }
  for (int pair = 0; pair < static_cast<int>(pairs.size()); ++pair) {
    const auto [i, j] = pairs[pair];
    factor->upper(pair) = RandomBlock(&random);
    dense.block<6, 6>(6 * i, 6 * j) = factor->upper(pair);
    dense.block<6, 6>(6 * j, 6 * i) = factor->upper(pair).transpose();
  }
  return dense;
}

Pairs RandomPairs(int bodies, int count, std::uint64_t seed) {
  test::Random random(seed);
  std::set<BodyPair> pairs;
  for (int k = 0; k < count; ++k) {
    const int i = random.Index(bodies), j = random.Index(bodies);
    if (i != j) pairs.insert(std::minmax(i, j));
  }
  return {pairs.begin(), pairs.end()};
}

Pairs Clique(int bodies) {
  Pairs pairs;
  for (int i = 0; i < bodies; ++i) {
    for (int j = i + 1; j < bodies; ++j) pairs.emplace_back(i, j);
  }
  return pairs;
}

Pairs Chain(int bodies) {
  Pairs pairs;
  for (int i = 0; i + 1 < bodies; ++i) pairs.emplace_back(i, i + 1);
  return pairs;
}

/// Everybody touches body 0, which an ordering puts last: every pair is turned round.
Pairs Star(int bodies) {
  Pairs pairs;
  for (int i = 1; i < bodies; ++i) pairs.emplace_back(0, i);
  return pairs;
}

// With 4 bodies added on the diagonal the condition is below 100: 1e-13 is rounding.
void ExpectSolves(BlockCholesky* factor, int bodies, const Pairs& pairs, std::uint64_t seed) {
  const Eigen::MatrixXd dense = Fill(factor, bodies, pairs, 8.0 * bodies, seed);
  ASSERT_TRUE(factor->Factorise());
  test::Random random(seed + 1);
  std::vector<Vector6d> rhs(bodies);
  Eigen::VectorXd flat(6 * bodies);
  for (int i = 0; i < bodies; ++i) {
    for (int k = 0; k < 6; ++k) flat[6 * i + k] = rhs[i][k] = random.Uniform(-1, 1);
  }
  const Eigen::VectorXd expected = dense.llt().solve(flat);
  factor->Solve(rhs);
  for (int i = 0; i < bodies; ++i) {
    EXPECT_LT((rhs[i] - expected.segment<6>(6 * i)).norm(), 1e-13) << "body " << i;
  }
}

TEST(BlockCholesky, SolvesWhatTheDenseFactorSolves) {
  const std::vector<std::pair<int, Pairs>> patterns = {{1, {}},
                                                       {5, {}},
                                                       {2, {{0, 1}}},
                                                       {7, Clique(7)},
                                                       {20, Chain(20)},
                                                       {12, Star(12)},
                                                       {3, {{0, 2}}},
                                                       {40, RandomPairs(40, 60, 1)},
                                                       {40, RandomPairs(40, 200, 2)},
                                                       {25, RandomPairs(25, 25, 3)}};
  BlockCholesky factor;  // one for all: what an earlier pattern left must not matter
  for (const auto& [bodies, pairs] : patterns) {
    SCOPED_TRACE(testing::Message() << bodies << " bodies, " << pairs.size() << " pairs");
    factor.Analyse(bodies, pairs);
    for (std::uint64_t seed : {1, 2}) ExpectSolves(&factor, bodies, pairs, seed);
  }
}

TEST(BlockCholesky, SaysWhenTheMatrixIsNotPositiveDefinite) {
  for (const Pairs& pairs : {Chain(6), Star(6), Clique(6)}) {
    BlockCholesky factor;
    factor.Analyse(6, pairs);
    // Off-diagonal blocks outweigh the diagonal ones by far.
    const Eigen::MatrixXd dense = Fill(&factor, 6, pairs, 1e-3, 5);
    ASSERT_EQ(dense.llt().info(), Eigen::NumericalIssue);
    EXPECT_FALSE(factor.Factorise());
    ExpectSolves(&factor, 6, pairs, 7);  // and recovers
  }
}

// By hand: column k of the factor of one body has 6 - k entries, 1 + ... + 6 = 21 in all, and costs
// the square of that, 91. In a chain every body but the last has the next one below it: columns of
// 12 to 7. A clique of n is one dense triangle of 6 n.
TEST(BlockCholesky, CountsEntriesAndMultiplyAdds) {
  const auto counts = [](int bodies, const Pairs& pairs) {
    BlockCholesky factor;
    factor.Analyse(bodies, pairs);
    return std::pair(factor.factor_nonzeros(), factor.factor_flops());
  };
  EXPECT_EQ(counts(1, {}), std::pair(21.0, 91.0));
  EXPECT_EQ(counts(3, {}), std::pair(63.0, 273.0));
  const double next = 12 + 11 + 10 + 9 + 8 + 7, next_flops = 144 + 121 + 100 + 81 + 64 + 49;
  EXPECT_EQ(counts(10, Chain(10)), std::pair(9 * next + 21, 9 * next_flops + 91));
  EXPECT_EQ(counts(10, Star(10)), std::pair(9 * next + 21, 9 * next_flops + 91));  // no fill
  EXPECT_EQ(counts(4, Clique(4)), std::pair(24.0 * 25 / 2, 24.0 * 25 * 49 / 6));
}

}  // namespace
}  // namespace cairn
