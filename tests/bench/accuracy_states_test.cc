// SPDX-License-Identifier: MIT
// cairn_accuracy on given states: what is compared with what, and that nothing of it stays.
#include <btBulletDynamicsCommon.h>
#include <cairn/bullet/constraint_solver.h>
#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "accuracy/bullet_trial.h"
#include "accuracy/shadow.h"
#include "accuracy/states/states.h"
#include "measure/converged.h"
#include "measure/reference.h"
#include "measure/velocity_norm.h"
#include "run/scene_choice.h"
#include "run/scene_run.h"

namespace cairn::accuracy {
namespace {

cli::SceneChoice Scene(const char* name, int size) {
  const std::vector<std::string> names = {name};
  return cli::ParseScenes(names, std::to_string(size), 0).front();
}

/// The tenth frame of a small scene.
class OneState : public testing::TestWithParam<const char*> {
 protected:
  template <class Look>
  void WithState(Look look) {
    cli::StateRun run(Scene(GetParam(), 5), 50);
    for (int i = 0; i < 10; ++i) run.Step();
    bool looked = false;
    run.StepAfter([&](bench::Substep* substep, const btContactSolverInfo& info) {
      const RecordedSubstep recorded = BulletTrial().Record(*substep, info);
      look(*substep, info, recorded);
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
                const RecordedSubstep& recorded) {
    const bench::ContactFrame& frame = recorded.frame;
    BulletTrial trial;
    const BulletTime time = trial.Solve(substep, info, 10);
    EXPECT_GT(time.set_up, 0);
    EXPECT_GT(time.iterations, 0);
    EXPECT_GT(time.finish, 0);

    const bench::ContactFrame again = trial.Record(substep, info).frame;
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
                const RecordedSubstep& recorded) {
    const bench::ContactFrame& frame = recorded.frame;
    const bench::VelocityNorm norm(frame.bodies);
    const bench::Converged reference = bench::Converge(frame, norm);
    EXPECT_EQ(reference.reached, reference.residual_max <= bench::kConvergedTo);
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

// The adapter makes rows of its own, those of contacts in floats: a tower makes 1e-4 m/s of their
// rounding.
TEST_P(OneState, TheAdapterConvergesToTheReferenceOfBulletsRows) {
  WithState([&](const bench::Substep& substep, const btContactSolverInfo& info,
                const RecordedSubstep& recorded) {
    const bench::VelocityNorm norm(recorded.frame.bodies);
    const bench::Converged reference = bench::Converge(recorded.frame, norm);
    bullet::ConstraintSolver adapter(bench::ReferenceSettings());
    substep.Restore();
    substep.SolveWith(&adapter, info, nullptr);

    EXPECT_FALSE(adapter.fell_back());
    EXPECT_LT(norm.Between(recorded.Changes(), reference.velocities).rms, 2e-4);
  });
}

/// Errors of a few sweeps on the last of some frames of a chain, by a shadow that saw so many of
/// them.
double ErrorOfFewSweeps(int frames_seen) {
  constexpr int kFrames = 60, kSweeps = 20;
  constexpr double kDay = 86400e3;  // [ms]
  Settings settings = SettingsOf(Kind::kSweeps);
  settings.max_sweeps = kSweeps;
  Shadow shadow(settings);
  cli::StateRun run(Scene("chain", 5), 50);
  double error = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    run.StepAfter([&](bench::Substep* substep, const btContactSolverInfo& info) {
      if (frame < kFrames - frames_seen) return;
      const RecordedSubstep recorded = BulletTrial().Record(*substep, info);
      EXPECT_EQ(shadow.Solve(*substep, info, kDay).sweeps, kSweeps);
      const bench::VelocityNorm norm(recorded.frame.bodies);
      error =
          norm.Between(recorded.Changes(), bench::Converge(recorded.frame, norm).velocities).rms;
    });
  }
  return error;
}

// From impulses of the frame before; gravity changes them little.
TEST(Shadow, StartsJointsFromItsOwnImpulsesOfTheFrameBefore) {
  EXPECT_LT(ErrorOfFewSweeps(10), 0.5 * ErrorOfFewSweeps(1));
}

TEST(Shadow, LeavesContactsAndJointsToBeRestored) {
  cli::StateRun run(Scene("tower", 5), 50);
  Shadow shadow(SettingsOf(Kind::kSteps));
  for (int frame = 0; frame < 5; ++frame) {
    run.StepAfter([&](bench::Substep* substep, const btContactSolverInfo& info) {
      const std::vector<double> before = substep->Impulses();
      const ShadowFrame solved = shadow.Solve(*substep, info, 1);
      EXPECT_GT(solved.sweeps, 0);
      EXPECT_GT(solved.time.wall, 0);
      EXPECT_FALSE(solved.empty);
      substep->Restore();
      EXPECT_EQ(substep->Impulses(), before);
    });
  }
}

ShadowFrame FrameWith(double over, int accepted, int restored) {
  ShadowFrame frame;
  frame.budget = 1;
  frame.time = {.cpu = 1 + over, .wall = 1 + 2 * over, .preempted = false};
  frame.accepted = accepted;
  frame.restored = restored;
  frame.factorisations = 2 * frame.steps();
  return frame;
}

TEST(FrameStatistics, CountStepsAndTimesByHand) {
  std::vector<ShadowFrame> frames = {FrameWith(-0.01, 0, 0), FrameWith(0.02, 2, 1),
                                     FrameWith(0.03, 1, 0), FrameWith(0.5, 0, 0)};
  frames[1].step_predicted = 0.4;
  frames[1].step_time = 0.3;
  frames[2].step_predicted = 0.1;
  frames[2].step_time = 0.2;
  frames[3].time.preempted = true;

  const FrameStatistics result = StatisticsOf(frames);

  EXPECT_EQ(result.frames, 4);
  EXPECT_EQ(result.interrupted, 1);
  EXPECT_DOUBLE_EQ(result.stepped, 0.5);
  EXPECT_DOUBLE_EQ(result.restored, 0.25);
  EXPECT_DOUBLE_EQ(result.factorisations, 2);
  EXPECT_NEAR(result.cpu_over.p50, 20, 1e-9);
  EXPECT_NEAR(result.cpu_over.max, 500, 1e-9);
  EXPECT_NEAR(result.wall_over.max, 1000, 1e-9);
  EXPECT_NEAR(result.wall_over_calm.max, 60, 1e-9);
  EXPECT_DOUBLE_EQ(result.step_error.p50, 0.25);
  EXPECT_DOUBLE_EQ(result.step_error.p99, 1);
}

TEST(FrameStatistics, OfNoStepAreNone) {
  const FrameStatistics result = StatisticsOf(std::vector<ShadowFrame>{FrameWith(0, 0, 0)});
  EXPECT_EQ(result.stepped, 0);
  EXPECT_TRUE(std::isnan(result.restored));
  EXPECT_TRUE(std::isnan(result.step_error.p50));
}

TEST(States, AreMeasuredWithFiniteErrorsAndConvergedReferences) {
  StatesOptions options{.scenes = {}, .frames = 40, .samples = 2, .rounds = 3};

  const SceneStates result = MeasureStates(Scene("chain", 10), options, [](const std::string&) {});

  ASSERT_EQ(result.states.size(), 2u);
  EXPECT_EQ(result.frames.size(), 30u);  // the first ten are left out
  for (const StateResult& state : result.states) {
    EXPECT_EQ(state.rows, 33);
    EXPECT_TRUE(state.reference.reached) << state.reference.residual_max;
    EXPECT_GT(state.bullet_error.rms, 100 * state.reference.spread.rms);
    EXPECT_GT(state.bullet_time.iterations, 0);
    for (const Kind kind : kKinds) {
      const CairnResult& cairn = state.Of(kind);
      EXPECT_TRUE(std::isfinite(cairn.error.rms));
      EXPECT_GT(cairn.frame.sweeps, 0);
      EXPECT_DOUBLE_EQ(cairn.frame.budget, state.bullet_time.total());
      if (cairn.worth) {
        EXPECT_LE(*cairn.worth, state.followed);
      }
      if (kind != Kind::kSteps) {
        EXPECT_EQ(cairn.frame.factorisations, 0);
      }
    }
  }
}

TEST(States, CompareStepsWithOthers) {
  StateResult state;
  state.cairn[static_cast<size_t>(Kind::kSteps)].error.rms = 1;
  state.cairn[static_cast<size_t>(Kind::kSweeps)].error.rms = 0.9;
  state.cairn[static_cast<size_t>(Kind::kAccelerated)].error.rms = 0.99;
  EXPECT_TRUE(state.StepsAreWorseThan(Kind::kSweeps));
  EXPECT_FALSE(state.StepsAreWorseThan(Kind::kAccelerated));
  state.reference.spread.rms = 0.1;
  EXPECT_FALSE(state.StepsAreWorseThan(Kind::kSweeps));
}

}  // namespace
}  // namespace cairn::accuracy
