// SPDX-License-Identifier: MIT
// Sweeps over whitened rows against the textbook loop on the dense matrix A = J M^-1 J' + E.
#include "reference/row_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "problem/islands.h"
#include "tests/core/support/dense.h"
#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using test::Scene;

/// Start values of all signs, outside some bounds too.
std::vector<double> RandomImpulses(const Scene& scene, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<double> x(scene.rows.size());
  for (double& value : x) value = random.Uniform(-1, 1);
  return x;
}

/// Tells one relaxation from another.
void VaryRelaxation(Scene* scene, std::uint64_t seed) {
  test::Random random(seed);
  for (Row& row : scene->rows) row.relaxation = random.Uniform(0.5, 1.5);
}

Eigen::VectorXd DenseSweeps(const Scene& scene, const std::vector<double>& start, int sweeps) {
  const test::Dense dense = test::MakeDense(scene);
  Eigen::VectorXd x = test::ToVector(start);
  for (int i = 0; i < x.size(); ++i) x[i] = test::Project(scene, x, i, x[i]);
  for (int k = 0; k < sweeps; ++k) test::DenseSweep(scene, dense, &x);
  return x;
}

// The two add the same products in another order: 1e-12 leaves room for some thousand roundings.
TEST(SweepRows, MakesTheSweepsOfTheTextbook) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Scene scene = test::RandomPile({.bodies = 12, .contacts = 25, .pins = 4}, seed);
    VaryRelaxation(&scene, seed);
    const std::vector<double> start = RandomImpulses(scene, seed);
    const Eigen::VectorXd expected = DenseSweeps(scene, start, 10);
    const test::Solution s = test::Solve(test::PlainSweeps(10), scene, start);
    EXPECT_EQ(s.report.sweeps, 10);
    EXPECT_LT((test::ToVector(s.x) - expected).norm(), 1e-12 * expected.norm()) << seed;
    EXPECT_GT(s.report.residual_max, 1e-3) << "too easy: any order of rows would end here";
  }
}

// The same rows backwards give another iterate: the test above does see the order.
TEST(SweepRows, KeepTheOrderOfTheRows) {
  Scene scene = test::RandomPile({.bodies = 12, .contacts = 0, .pins = 20}, 5);
  const std::vector<double> start(scene.rows.size(), 0);
  const Eigen::VectorXd forward = DenseSweeps(scene, start, 10);
  std::reverse(scene.rows.begin(), scene.rows.end());
  const Eigen::VectorXd backward = DenseSweeps(scene, start, 10).reverse();
  ASSERT_GT((forward - backward).norm(), 0.01 * forward.norm());

  const test::Solution s = test::Solve(test::PlainSweeps(10), scene, start);
  EXPECT_LT((test::ToVector(s.x).reverse() - backward).norm(), 1e-12 * backward.norm());
}

// d |change of x|: a mass of 1/4 kg moved by 0.5 m/s needs 1/8 N s.
TEST(SweepRows, ReportTheLargestVelocityTheyMoved) {
  Scene scene;
  scene.bodies = {test::PointMass(0.25)};
  scene.rows = {test::LinearRow(0, kWorld, {1, 0, 0}), test::LinearRow(0, kWorld, {0, 1, 0})};
  scene.rows[0].target = 0.125;
  scene.rows[1].target = -0.5;
  const Packer packer(scene.problem(), Settings{});
  const Island island = FindIslands(scene.problem()).front();
  const PackedIsland packed = packer.Pack(island);
  IslandState state = Packer::Start(packed, island, std::vector<double>(2, 0.0));

  EXPECT_EQ(SweepRows(packed, {0, 1, 0}, detail::LiftedFriction::kRelease, &state), 0.125);
  EXPECT_EQ(state.x, (Array<double>{0.03125, 0}));
  EXPECT_EQ(SweepRows(packed, {0, 2, 0}, detail::LiftedFriction::kRelease, &state), 0.5);
  EXPECT_EQ(state.x, (Array<double>{0.03125, -0.125}));
  EXPECT_EQ(SweepRows(packed, {0, 2, 0}, detail::LiftedFriction::kRelease, &state), 0);
}

// Blocks are only where the budget is looked at.
TEST(SweepRows, InBlocksAreTheSweepsInOne) {
  const Scene scene = test::RandomPile({.bodies = 12, .contacts = 25}, 9);
  const Packer packer(scene.problem(), Settings{});
  for (const Island& island : FindIslands(scene.problem())) {
    const PackedIsland packed = packer.Pack(island);
    const int rows = static_cast<int>(packed.rows.size());
    const std::vector<double> start(scene.rows.size(), 0);
    IslandState whole = Packer::Start(packed, island, start), blocks = whole;
    for (int sweep = 0; sweep < 3; ++sweep) {
      SweepRows(packed, {0, rows, sweep}, detail::LiftedFriction::kRelease, &whole);
      for (int begin = 0; begin < rows; begin += 7) {
        SweepRows(packed, {begin, std::min(begin + 7, rows), sweep},
                  detail::LiftedFriction::kRelease, &blocks);
      }
    }
    EXPECT_EQ(whole.x, blocks.x);
    EXPECT_EQ(whole.u, blocks.u);
  }
}

}  // namespace
}  // namespace cairn
