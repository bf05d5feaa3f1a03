// SPDX-License-Identifier: MIT
// The parts of cairn_accuracy: what they call an error, and whose.
#include <btBulletDynamicsCommon.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "accuracy/bullet_trial.h"
#include "accuracy/converged.h"
#include "accuracy/grid.h"
#include "accuracy/intervals.h"
#include "accuracy/state_run.h"
#include "accuracy/states.h"
#include "accuracy/velocity_norm.h"
#include "measure/reference.h"
#include "scenes/facts.h"

namespace cairn::accuracy {
namespace {

using testing::HasSubstr;

cli::SceneChoice Scene(const char* name, int size) {
  return {.info = bench::FindScene(name), .size = size, .seed = 0};
}

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

  const VelocityDistance distance = VelocityNorm(bodies).Between(wrong, right);

  EXPECT_DOUBLE_EQ(distance.rms, std::sqrt(24.0 / 8));
  EXPECT_DOUBLE_EQ(distance.max, 3);
}

TEST(VelocityNorm, LeavesOutWhatCannotMove) {
  std::vector<Body> bodies = {Body{}, BodyOf(1, 1)};
  bodies[1].linear_factor.y() = 0;
  bodies[1].inv_inertia.row(0).setZero();
  bodies[1].inv_inertia.col(0).setZero();
  std::vector<Velocity> right(2), wrong(2);
  wrong[0].angular.x() = 5;
  wrong[1].linear.y() = wrong[1].angular.x() = 5;

  EXPECT_EQ(VelocityNorm(bodies).Between(wrong, right).rms, 0);
}

TEST(VelocityNorm, CallsNanInfinitelyWrong) {
  const std::vector<Body> bodies = {BodyOf(1, 1)};
  std::vector<Velocity> right(1), wrong(1);
  wrong[0].angular.x() = std::numeric_limits<double>::quiet_NaN();

  EXPECT_EQ(VelocityNorm(bodies).Between(wrong, right).rms, kInfinity);
}

// P(Binomial(20, 1/2) <= 5) = 2.07 %, <= 6: 5.8 %. So from the 6th to the 15th of 20 values.
TEST(Intervals, OfTheMedianOf20ValuesReachesFromThe6thToThe15th) {
  std::vector<double> values(20);
  std::iota(values.rbegin(), values.rend(), 1);

  const Interval interval = MedianInterval(values);

  EXPECT_EQ(interval.value, 10);
  EXPECT_EQ(interval.low, 6);
  EXPECT_EQ(interval.high, 15);
}

// P(Binomial(6, 1/2) = 0) = 1.6 % and P(Binomial(8, 1/2) <= 1) = 3.5 %, which is too much.
TEST(Intervals, OfFewValuesReachFromTheSmallestToTheLargest) {
  for (const int count : {2, 5, 6, 8}) {
    std::vector<double> values(count);
    std::iota(values.begin(), values.end(), 1);
    EXPECT_EQ(MedianInterval(values).low, 1) << count;
    EXPECT_EQ(MedianInterval(values).high, count) << count;
  }
  EXPECT_TRUE(std::isnan(MedianInterval({}).value));
}

// Wilson's interval of 0 of 20: [0, z^2 / (n + z^2)]; of 10 of 20 it is 1/2 -+ 0.2007.
TEST(Intervals, OfSharesAreThoseOfWilson) {
  EXPECT_EQ(ShareInterval(0, 20).low, 0);
  EXPECT_NEAR(ShareInterval(0, 20).high, 3.8415 / 23.8415, 1e-4);
  EXPECT_NEAR(ShareInterval(10, 20).low, 0.5 - 0.2007, 1e-4);
  EXPECT_NEAR(ShareInterval(20, 20).low, 1 - 3.8415 / 23.8415, 1e-4);
}

/// The tenth frame of a small scene.
class OneState : public testing::TestWithParam<const char*> {
 protected:
  template <class Look>
  void WithState(Look look) {
    StateRun run(Scene(GetParam(), 5), 50);
    for (int i = 0; i < 10; ++i) run.Step();
    bool looked = false;
    run.StepAfter([&](bench::Substep* substep, const btContactSolverInfo& info) {
      const bench::ContactFrame frame = BulletTrial().Rows(*substep, info);
      look(*substep, info, frame);
      looked = true;
    });
    EXPECT_TRUE(looked);
  }
};

INSTANTIATE_TEST_SUITE_P(Scenes, OneState, testing::Values("tower", "chain"),
                         [](const auto& scene) { return std::string(scene.param); });

/// Velocity of a substep's bodies after the solver wrote it back.
std::vector<double> WrittenBack(const bench::Substep& substep) {
  std::vector<double> values;
  for (const Velocity& v : bench::ReadVelocities(substep.bodies())) {
    for (int i = 0; i < 3; ++i) values.insert(values.end(), {v.linear[i], v.angular[i]});
  }
  return values;
}

TEST_P(OneState, FollowedIterationsAreThoseOfStockBullet) {
  WithState([&](const bench::Substep& substep, const btContactSolverInfo& info, const auto&) {
    btSequentialImpulseConstraintSolver stock;
    btContactSolverInfo ten = info;
    ten.m_numIterations = 10;
    substep.Restore();
    substep.SolveWith(&stock, ten, nullptr);
    const std::vector<double> expected = WrittenBack(substep);

    std::vector<int> iterations;
    BulletTrial trial;
    trial.Follow(substep, info, 1000, [&](int iteration, std::span<const Velocity>) {
      iterations.push_back(iteration);
      return iteration < 10;
    });

    EXPECT_EQ(iterations.size(), 11u);
    EXPECT_EQ(iterations.front(), 0);
    EXPECT_EQ(WrittenBack(substep), expected);
  });
}

TEST_P(OneState, TrialsLeaveNoTrace) {
  WithState([&](const bench::Substep& substep, const btContactSolverInfo& info,
                const bench::ContactFrame& frame) {
    BulletTrial trial;
    const BulletTime time = trial.Solve(substep, info, 10);
    EXPECT_GT(time.set_up, 0);
    EXPECT_GT(time.iterations, 0);
    EXPECT_GT(time.finish, 0);

    const bench::ContactFrame again = trial.Rows(substep, info);
    EXPECT_EQ(again.impulses, frame.impulses);
    ASSERT_EQ(again.rows.size(), frame.rows.size());
    for (size_t i = 0; i < frame.rows.size(); ++i) {
      EXPECT_EQ(again.rows[i].target, frame.rows[i].target) << i;
    }
  });
}

// Bullet makes the same sweeps in floats: what is left after many is rounding. Were the reference
// that of another problem, centimetres per second would be left.
TEST_P(OneState, BulletConvergesToTheReference) {
  WithState([&](const bench::Substep& substep, const btContactSolverInfo& info,
                const bench::ContactFrame& frame) {
    const VelocityNorm norm(frame.bodies);
    const Converged reference = Converge(frame, norm);
    EXPECT_EQ(reference.reached, reference.residual_max <= kConvergedTo);
    EXPECT_LT(reference.residual_max, 1e-4);
    EXPECT_LT(reference.spread.rms, 1e-5);

    std::vector<double> errors;
    BulletTrial().Follow(substep, info, 50000, [&](int, std::span<const Velocity> velocities) {
      errors.push_back(norm.Between(velocities, reference.velocities).rms);
      return true;
    });
    EXPECT_GT(errors[10], 1e-3);
    EXPECT_LT(errors.back(), 1e-5);
  });
}

TEST(States, AreMeasuredWithFiniteErrorsAndConvergedReferences) {
  StatesOptions options{.scenes = {}, .frames = 40, .samples = 2, .rounds = 3};

  const SceneStates result = MeasureStates(Scene("chain", 10), options, [](const std::string&) {});

  ASSERT_EQ(result.states.size(), 2u);
  for (const StateResult& state : result.states) {
    EXPECT_EQ(state.rows, 33);
    EXPECT_TRUE(state.reference.reached) << state.reference.residual_max;
    EXPECT_GT(state.bullet_error.rms, 100 * state.reference.spread.rms);
    EXPECT_GT(state.bullet_time.iterations, 0);
    for (const Share share : kShares) {
      for (const Kind kind : kKinds) {
        const CairnResult& cairn = state.Of(share, kind);
        EXPECT_EQ(cairn.rounds, 3);
        EXPECT_TRUE(std::isfinite(cairn.error.rms));
        EXPECT_LE(cairn.least_rms, cairn.error.rms);
        EXPECT_LE(cairn.error.rms, cairn.most_rms);
        if (cairn.worth) {
          EXPECT_LE(*cairn.worth, state.followed);
        }
        if (kind == Kind::kSweeps) {
          EXPECT_EQ(cairn.factorisations, 0);
        }
      }
    }
  }
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
