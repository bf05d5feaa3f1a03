// SPDX-License-Identifier: MIT
// The step in body space against the same proximal system, dense and in constraint space:
//   (A_FF + E + eps D) dx = r,  r = -w of the free rows with the others at their bounds.
#include "reference/step.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "reference/residual.h"
#include "tests/core/support/dense.h"
#include "tests/core/support/packed.h"
#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using test::Packed;
using test::Scene;

struct DenseStep {
  const Scene& scene;
  test::Dense dense;
  StepSettings settings;

  Eigen::VectorXd Solve(const ActiveSet& set, Eigen::VectorXd x) const;
  Eigen::VectorXd Take(const PackedIsland& island, const IslandState& start) const;
};

/// One solve for the rows that are free in @p set.
Eigen::VectorXd DenseStep::Solve(const ActiveSet& set, Eigen::VectorXd x) const {
  std::vector<int> free;
  for (int i = 0; i < x.size(); ++i) {
    if (set[i] == RowSide::kFree) {
      free.push_back(i);
    } else {
      x[i] = test::Project(scene, x, i, set[i] == RowSide::kLo ? -1e300 : 1e300);
    }
  }
  const Eigen::VectorXd r = dense.b - dense.A * x;
  Eigen::MatrixXd reduced = dense.A(free, free);
  for (size_t k = 0; k < free.size(); ++k) {
    const Row& row = scene.rows[free[k]];
    const bool joint = row.parent == kNoRow && row.lo == -kInfinity && row.hi == kInfinity;
    const double eps = joint ? settings.proximal_joints : settings.proximal;
    reduced(k, k) += eps * dense.A(free[k], free[k]);
  }
  const Eigen::VectorXd dx = reduced.ldlt().solve(r(free));
  for (size_t k = 0; k < free.size(); ++k) x[free[k]] += dx[k];
  return x;
}

/// The sets are those of active_set.h, tested by hand elsewhere. A refinement after which a row
/// leaves its bounds is taken back.
Eigen::VectorXd DenseStep::Take(const PackedIsland& island, const IslandState& start) const {
  ActiveSet set = PredictActiveSet(island, start);
  const auto removed = [&](const Eigen::VectorXd& x) {
    const IslandState state{.x = {x.begin(), x.end()}, .u = {}};
    return RemoveViolated(island, state, &set) > 0;
  };
  Eigen::VectorXd x;
  for (int pass = 0; pass < settings.factorisations; ++pass) {
    x = Solve(set, test::ToVector(start.x));
    if (removed(x)) continue;
    for (int k = 1; k < settings.refinements; ++k) {
      const Eigen::VectorXd refined = Solve(set, x);
      if (removed(refined)) break;
      x = refined;
    }
    break;
  }
  for (int i = 0; i < x.size(); ++i) x[i] = test::Project(scene, x, i, x[i]);
  return x;
}

/// Largest difference of the two, relative to the largest impulse.
double StepError(const Scene& scene, int sweeps, const StepSettings& settings) {
  Packed packed(scene, sweeps);
  const DenseStep oracle{scene, test::MakeDense(scene), settings};
  const Eigen::VectorXd expected = oracle.Take(packed.island, packed.state);

  BodySystem system;
  system.Prepare(packed.island);
  EXPECT_TRUE(TakeStep(packed.island, settings, &system, &packed.state).solved);
  IslandState consistent = packed.state;
  RecomputeVelocities(packed.island, &consistent);
  EXPECT_EQ(packed.state.u, consistent.u);
  const Eigen::VectorXd error = test::ToVector(packed.state.x) - expected;
  return error.cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

/// RandomPile() with a pin between each body and the next: one island.
Scene ConnectedPile(std::uint64_t seed) {
  Scene scene = test::RandomPile({.bodies = 10, .contacts = 25, .world_share = 0.3}, seed);
  for (int i = 0; i + 1 < 10; ++i) {
    test::AddPin(&scene, i, i + 1, 0.5 * (scene.positions[i] + scene.positions[i + 1]));
  }
  return scene;
}

// Recovering impulses from velocities divides rounding by eps, 1e-16 / 1e-4: 1e-9 is room for the
// sums.
TEST(TakeStep, SolvesTheProximalSystemOfItsFreeRows) {
  const StepSettings settings{
      .proximal = 3e-3, .proximal_joints = 1e-4, .factorisations = 1, .refinements = 1};
  EXPECT_LT(StepError(test::Tower(4), 20, settings), 1e-9);
  EXPECT_LT(StepError(test::HangingChain(12, 30), 20, settings), 1e-9);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_LT(StepError(ConnectedPile(seed), 20, settings), 1e-9) << seed;
  }
}

// The default of joints, 1e-8, leaves 1e-8 of the digits. What matters is that w goes to zero.
TEST(TakeStep, SolvesJointsWithTheTinyProximalTermOfTheDefaults) {
  const StepSettings settings{
      .proximal = 3e-3, .proximal_joints = 1e-8, .factorisations = 1, .refinements = 1};
  EXPECT_LT(StepError(test::HangingChain(12, 30), 20, settings), 1e-6);
}

TEST(TakeStep, RemovesRowsThatLeftTheirBoundsAndSolvesAgain) {
  const auto settings = [](int factorisations) {
    return StepSettings{.proximal = 3e-3,
                        .proximal_joints = 1e-4,
                        .factorisations = factorisations,
                        .refinements = 1};
  };
  int different = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene scene = ConnectedPile(seed);
    for (int passes : {2, 5}) EXPECT_LT(StepError(scene, 20, settings(passes)), 1e-9) << seed;

    Packed packed(scene, 20);
    BodySystem system;
    system.Prepare(packed.island);
    if (TakeStep(packed.island, settings(2), &system, &packed.state).factorisations == 2) {
      ++different;
    }
  }
  EXPECT_GT(different, 10) << "nothing was removed";
}

TEST(TakeStep, RefinesWithTheSameFactorFromWhereItIs) {
  const Scene scene = test::HangingChain(12, 30);
  const StepSettings settings{
      .proximal = 3e-3, .proximal_joints = 1e-3, .factorisations = 1, .refinements = 3};
  Packed packed(scene, 5);
  const DenseStep oracle{scene, test::MakeDense(scene), settings};
  const ActiveSet set = PredictActiveSet(packed.island, packed.state);
  Eigen::VectorXd expected = test::ToVector(packed.state.x);
  for (int k = 0; k < 3; ++k) expected = oracle.Solve(set, expected);

  BodySystem system;
  system.Prepare(packed.island);
  const StepResult result = TakeStep(packed.island, settings, &system, &packed.state);
  EXPECT_EQ(result.factorisations, 1);
  EXPECT_LT((test::ToVector(packed.state.x) - expected).norm(), 1e-9 * expected.norm());
}

// A timid first solve keeps the set, and a later one, that goes further, leaves it.
TEST(TakeStep, TakesBackARefinementAfterWhichARowLeavesItsBounds) {
  int refined = 0, taken_back = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Scene scene = ConnectedPile(seed);
    const auto settings = [](int refinements) {
      return StepSettings{
          .proximal = 0.3, .proximal_joints = 0.1, .factorisations = 3, .refinements = refinements};
    };
    std::vector<Array<double>> results;
    for (int refinements : {1, 2, 3, 12, 13}) {
      EXPECT_LT(StepError(scene, 20, settings(refinements)), 1e-9) << seed;
      Packed packed(scene, 20);
      BodySystem system;
      system.Prepare(packed.island);
      ASSERT_TRUE(TakeStep(packed.island, settings(refinements), &system, &packed.state).solved);
      results.push_back(packed.state.x);
    }
    if (results[0] == results[1]) continue;
    ++refined;
    if (results[3] == results[4]) ++taken_back;
  }
  EXPECT_GT(refined, 5);
  EXPECT_GT(taken_back, 5);
}

TEST(TakeStep, KeepsTheBoundsWhateverItDoes) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene scene = ConnectedPile(seed);
    for (int refinements : {1, 2, 5}) {
      Packed packed(scene, 3);
      BodySystem system;
      system.Prepare(packed.island);
      const StepSettings settings{.proximal = 3e-3,
                                  .proximal_joints = 1e-8,
                                  .factorisations = 2,
                                  .refinements = refinements};
      ASSERT_TRUE(TakeStep(packed.island, settings, &system, &packed.state).solved);
      const Eigen::VectorXd x = test::ToVector(packed.state.x);
      for (int i = 0; i < x.size(); ++i) ASSERT_EQ(x[i], test::Project(scene, x, i, x[i]));
    }
  }
}

// One set of memory serves islands of other sizes and graphs, frame after frame.
TEST(BodySystem, IsPreparedAnewForAnotherGraph) {
  const StepSettings settings{
      .proximal = 3e-3, .proximal_joints = 1e-6, .factorisations = 2, .refinements = 1};
  BodySystem shared;
  for (const Scene& scene : {test::Tower(5), test::HangingChain(5, 2), test::HangingChain(9, 2),
                             ConnectedPile(1), ConnectedPile(2), test::Tower(1)}) {
    Packed packed(scene, 5), again(scene, 5);
    BodySystem own;
    own.Prepare(packed.island);
    shared.Prepare(again.island);
    EXPECT_EQ(own.factor_flops(), shared.factor_flops());
    ASSERT_TRUE(TakeStep(packed.island, settings, &own, &packed.state).solved);
    ASSERT_TRUE(TakeStep(again.island, settings, &shared, &again.state).solved);
    EXPECT_EQ(packed.state.x, again.state.x);
  }
}

}  // namespace
}  // namespace cairn
