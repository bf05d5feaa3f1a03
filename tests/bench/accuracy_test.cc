// SPDX-License-Identifier: MIT
// The parts of cairn_accuracy: what they call an error, and whose.
#include <btBulletDynamicsCommon.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "accuracy/grid/grid.h"
#include "cairn/detail/eigen.h"
#include "measure/velocity_norm.h"
#include "scenes/facts.h"

namespace cairn::accuracy {
namespace {

using testing::HasSubstr;

Body BodyOf(double mass, double inertia) {
  Body body;
  body.inv_mass = 1 / mass;
  body.inv_inertia = Eigen::Matrix3d::Identity() / inertia;
  return body;
}

// 2 kg at 3 m/s and 6 kg m^2 at 1 rad/s hold twice 9 + 3 J; the second body, 6 kg, is right:
// sqrt(24 J / 8 kg).
TEST(VelocityNorm, WeighsMassesAndInertias) {
  const std::vector<Body> bodies = {BodyOf(2, 6), BodyOf(6, 1)};
  std::vector<Velocity> right(2), wrong(2);
  wrong[0].linear.x() = 3;
  wrong[0].angular.z() = 1;

  const bench::VelocityDistance distance = bench::VelocityNorm(bodies).Between(wrong, right);

  EXPECT_DOUBLE_EQ(distance.rms, std::sqrt(24.0 / 8));
  EXPECT_DOUBLE_EQ(distance.max, 3);
}

TEST(VelocityNorm, LeavesOutWhatCannotMove) {
  std::vector<Body> bodies = {Body{}, BodyOf(1, 1)};
  bodies[1].linear_factor.y() = 0;
  View(bodies[1].inv_inertia).row(0).setZero();
  View(bodies[1].inv_inertia).col(0).setZero();
  std::vector<Velocity> right(2), wrong(2);
  wrong[0].angular.x() = 5;
  wrong[1].linear.y() = wrong[1].angular.x() = 5;

  EXPECT_EQ(bench::VelocityNorm(bodies).Between(wrong, right).rms, 0);
}

TEST(VelocityNorm, CallsNanInfinitelyWrong) {
  const std::vector<Body> bodies = {BodyOf(1, 1)};
  std::vector<Velocity> right(1), wrong(1);
  wrong[0].angular.x() = std::numeric_limits<double>::quiet_NaN();

  EXPECT_EQ(bench::VelocityNorm(bodies).Between(wrong, right).rms, kInfinity);
}

TEST(Grid, HasTheExtremesThatItIsFor) {
  const auto has = [](const std::vector<Cell>& cells, auto fits) {
    return std::any_of(cells.begin(), cells.end(), fits);
  };
  const auto check = [&](const std::vector<Cell>& cells, int links) {
    EXPECT_TRUE(has(cells, [&](const Cell& c) {
      return c.links == links && c.mass_ratio == 10000 && c.rate == 30;
    }));
    EXPECT_TRUE(has(cells, [](const Cell& c) { return c.links == 1 && c.rate == 240; }));
    for (const double friction : {0.0, 2.0}) {
      EXPECT_TRUE(has(cells, [&](const Cell& c) {
        return c.kind == Cell::Kind::kPile && c.friction == friction && c.mass_ratio == 10000;
      }));
    }
  };
  check(AllCells(), 1000);
  check(QuickCells(), 30);
}

TEST(Grid, BuildsWhatItSays) {
  btSequentialImpulseConstraintSolver solver;
  GridWorld pile({Cell::Kind::kPile, 100, 60, 0.5, 0}, &solver);
  EXPECT_NEAR(bench::TotalMass(pile.world()), 104, 1e-4);
  EXPECT_LT(pile.Defect(), 1e-6);
  GridWorld chain({Cell::Kind::kChain, 1000, 60, 0, 3}, &solver);
  EXPECT_NEAR(bench::TotalMass(chain.world()), 1003, 1e-3);
  EXPECT_LT(chain.Defect(), 1e-5);
  EXPECT_EQ(chain.world().joints().size(), 4u);
}

GridRun RunWith(double defect, double energy_gain) {
  GridRun run;
  run.defect = defect;
  run.energy_gain = energy_gain;
  return run;
}

TEST(Grid, ComparesDefectsAndEnergies) {
  GridResult result;
  result.runs = {RunWith(0.0127, 0.05), RunWith(0.009, 0), RunWith(1, 0.05)};
  EXPECT_TRUE(result.Worse());
  EXPECT_FALSE(result.Better());
  EXPECT_FALSE(result.GainsEnergy());
  result.runs = {RunWith(0.0001, 0.07), RunWith(0.0009, 0), RunWith(1, 0.05)};
  EXPECT_FALSE(result.Worse());
  EXPECT_FALSE(result.Better());  // not by a millimetre
  EXPECT_TRUE(result.GainsEnergy());
}

/// Sets a velocity in its third substep.
class Breaks : public btSequentialImpulseConstraintSolver {
 public:
  explicit Breaks(btScalar speed) : speed_(speed) {}
  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int count,
                                         const btContactSolverInfo& info) override {
    const btScalar result =
        btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyFinish(bodies, count, info);
    if (++substeps_ == 3) btRigidBody::upcast(bodies[0])->setLinearVelocity({0, speed_, 0});
    return result;
  }

 private:
  btScalar speed_;
  int substeps_ = 0;
};

TEST(Grid, TellsNanFromAnExplosion) {
  const Cell cell{Cell::Kind::kChain, 1, 60, 0, 2};
  Breaks to_nan(std::numeric_limits<btScalar>::quiet_NaN()), fast(2000);

  const GridRun not_a_number = RunCell(cell, &to_nan, GridOptions{}, {});
  const GridRun exploded = RunCell(cell, &fast, GridOptions{}, {});

  EXPECT_TRUE(not_a_number.not_a_number);
  EXPECT_FALSE(exploded.not_a_number);
  EXPECT_THAT(exploded.failure, HasSubstr("exploded"));
  for (const GridRun& run : {not_a_number, exploded}) {
    EXPECT_EQ(run.failed_in, 2);
    EXPECT_EQ(run.defect, kInfinity);
  }
}

TEST(Grid, NamesTheCellOfANan) {
  GridResult sound, bad;
  bad.cell = {Cell::Kind::kChain, 10000, 30, 0, 300};
  GridRun& run = bad.runs[static_cast<size_t>(GridSolver::kSteps)];
  run.not_a_number = true;
  run.failure = "a velocity is not a number";
  run.failed_in = 7;
  bad.runs[static_cast<size_t>(GridSolver::kBullet)].not_a_number = true;  // not ours to answer for

  const std::vector<std::string> sentences = NotNumbers({sound, bad});

  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_THAT(sentences[0], HasSubstr("frame 7 of a chain of 300 links, mass ratio 1:10000"));
  EXPECT_THAT(sentences[0], HasSubstr("steps"));
}

}  // namespace
}  // namespace cairn::accuracy
