// SPDX-License-Identifier: MIT
// Every scene for ten seconds, driven by Cairn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cairn/bullet/constraint_solver.h"
#include "measure/instrumented_solver.h"
#include "tests/bullet_adapter/scene_world.h"

namespace cairn::test {
namespace {

class CairnOnScene : public testing::TestWithParam<std::string_view> {};

bool AllFinite(const bench::World& world) {
  return std::ranges::all_of(world.dynamic_bodies(), [](const btRigidBody* body) {
    const btVector3 sum =
        body->getCenterOfMassPosition() + body->getLinearVelocity() + body->getAngularVelocity();
    return std::isfinite(sum.x()) && std::isfinite(sum.y()) && std::isfinite(sum.z());
  });
}

/// phi of all islands [J]
double Merit(const Report& report) {
  double merit = 0;
  for (const IslandReport& island : report.islands) merit += island.merit;
  return merit;
}

// Every 20th frame Cairn's sweeps alone, as many, get the same state. Each island keeps the better
// of both by the residual in energy, unless the step cut it to half, so the sum over islands may
// not be larger. Where something hits, sweeps that build on each other can be a percent behind.
TEST_P(CairnOnScene, Runs600FramesWithoutNanAndNeverWorseThanSweepsAlone) {
  // of the same bodies, so without what either learns of their tension
  const bullet::Options plain{.geometric_stiffness = false};
  bullet::ConstraintSolver cairn, with_steps({}, plain);
  bullet::ConstraintSolver sweeps({.k_sm = 0, .acceleration = Acceleration::kNone}, plain);
  bench::InstrumentedSolver instrumented(&cairn);
  SceneWorld world(GetParam(), &instrumented);
  // 1e-5 m/s of all bodies, which nobody sees [sqrt(J)]
  const double unseen = 1e-5 * std::sqrt(bench::TotalMass(world.world()));
  int compared = 0, worse = 0;
  for (int frame = 0; frame < 600; ++frame) {
    if (frame % 20 == 19) {
      instrumented.ProbeNext([&](bench::Substep* substep, const btContactSolverInfo& info) {
        substep->SolveWith(&with_steps, info, nullptr);
        substep->Restore();
        substep->SolveWith(&sweeps, info, nullptr);
        const Report& report = with_steps.report();
        // what is done is left alone, and without a step these are sweeps that build on each other
        const bool done = std::max(report.residual_max, report.residual_angular) <= 1e-4;
        if (done || report.steps_accepted == 0) return;
        ++compared;
        // or as close in energy to a thousandth, and at most four times as rough, or where it
        // begins far ahead; see StepTrial
        const double merit = Merit(sweeps.report()), lead = merit - Merit(with_steps.report());
        const double rough = with_steps.report().residual_energy;
        const bool closer = lead > -1e-3 * std::abs(merit);
        const double most = (closer ? 4 : 1.02) * sweeps.report().residual_energy + unseen;
        worse += rough > most && !(lead > 16 * rough * rough) ? 1 : 0;
      });
    }
    world.Step(1);
    ASSERT_TRUE(cairn.report().ok()) << Describe(cairn.report().status) << ", frame " << frame;
    ASSERT_TRUE(AllFinite(world.world())) << "frame " << frame;
  }
  // between two trials a step is taken for what the last ones gained
  EXPECT_LE(worse, 1);
  // others converge, or take no step there
  for (const std::string_view scene : {"castle", "tower", "heavy-top", "bridge"}) {
    if (GetParam() == scene) {
      EXPECT_GT(compared, 5);
    }
  }
}

TEST_P(CairnOnScene, GivesTheSameBitsTwice) {
  bullet::ConstraintSolver first, second;
  SceneWorld one(GetParam(), &first);
  one.Step(60);
  SceneWorld other(GetParam(), &second);
  other.Step(60);
  EXPECT_EQ(bench::StateHash(one.world()), bench::StateHash(other.world()));
}

INSTANTIATE_TEST_SUITE_P(Every, CairnOnScene, testing::ValuesIn(SceneNames()), SceneTestName());

}  // namespace
}  // namespace cairn::test
