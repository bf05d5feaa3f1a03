// SPDX-License-Identifier: MIT
// A substep that is no larger than one before is read, solved by sweeps and written without
// allocating. A program of its own, with an operator new that counts.
#include <gtest/gtest.h>

#include <string_view>

#include "cairn/bullet/constraint_solver.h"
#include "measure/instrumented_solver.h"
#include "tests/bullet_adapter/scene_world.h"
#include "tests/core/support/watched_new.h"

namespace cairn::test {
namespace {

/// Hands a whole substep over at once, as between prepareSolve() and allSolved().
void Solve(bench::Substep::Group* group, const btContactSolverInfo& info,
           bullet::ConstraintSolver* solver) {
  solver->solveGroup(group->bodies.data(), static_cast<int>(group->bodies.size()),
                     group->manifolds.data(), static_cast<int>(group->manifolds.size()),
                     group->joints.data(), static_cast<int>(group->joints.size()), info, nullptr,
                     nullptr);
}

class AllocationsOf : public testing::TestWithParam<std::string_view> {};

TEST_P(AllocationsOf, ASubstepAreNoneOnceItsSizeWasSeen) {
  btSequentialImpulseConstraintSolver driver;
  bench::InstrumentedSolver instrumented(&driver);
  SceneWorld world(GetParam(), &instrumented);
  world.world().solver_info().m_minimumSolverBatchSize = 1 << 30;  // all islands in one group
  world.Step(20);

  instrumented.ProbeNext([](bench::Substep* substep, const btContactSolverInfo& info) {
    bullet::ConstraintSolver solver({.k_sm = 0});
    for (bench::Substep::Group group : substep->groups()) {
      long before = NewCalls();
      Solve(&group, info, &solver);
      if (substep->groups().size() == 1) {
        EXPECT_GT(NewCalls(), before) << "counts nothing";
      }
      for (int repetition = 0; repetition < 3; ++repetition) {
        substep->Restore();
        before = NewCalls();
        Solve(&group, info, &solver);
        EXPECT_TRUE(repetition == 0 || NewCalls() == before) << repetition;
      }
      EXPECT_FALSE(solver.fell_back());
    }
  });
  world.Step(1);
}

INSTANTIATE_TEST_SUITE_P(Every, AllocationsOf,
                         testing::Values("pyramid", "ragdolls", "rubble", "chain"),
                         SceneTestName());

}  // namespace
}  // namespace cairn::test
