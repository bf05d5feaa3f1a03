// SPDX-License-Identifier: MIT
// Under a budget steps are spent where sweeps are slow, and not where they are fast.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using test::Scene;
using test::Solution;

/// Frames of the same scene from rest, by one solver, each with so much work for every row.
std::vector<Solution> Frames(const Scene& scene, int frames, double work_of_row, int k_sm,
                             int threads = 1) {
  Settings settings;
  settings.threads = threads;
  settings.path = Path::kFast;
  settings.tolerance = 0;
  settings.max_sweeps = std::numeric_limits<int>::max();
  settings.k_sm = k_sm;
  const double work = work_of_row * static_cast<double>(scene.rows.size());
  settings.budget = Budget::Work(static_cast<std::int64_t>(work));
  Solver solver(settings);
  std::vector<Solution> solutions;
  for (int frame = 0; frame < frames; ++frame) solutions.push_back(test::Solve(&solver, scene));
  return solutions;
}

// Bricks in two courses, from rest: 62 sweeps bring the residual down to a millionth. The first
// frame may try a step, as nothing is known of the scene.
TEST(StepBudget, IsLeftToSweepsWhereTheyAreFast) {
  constexpr int kFrames = 30;
  const Scene flat = test::Wall(20, 2);
  const auto steps = Frames(flat, kFrames, 80, 2), sweeps = Frames(flat, kFrames, 80, 0);
  for (int frame = 1; frame < kFrames; ++frame) {
    EXPECT_EQ(steps[frame].report.factorisations, 0) << frame;
    EXPECT_EQ(steps[frame].report.islands[0].no_step, NoStep::kSweepsFaster) << frame;
    EXPECT_TRUE(test::SameBits(steps[frame], sweeps[frame])) << frame;
  }
}

// The first frame of a graph pays for its analysis; the same frame again does not.
TEST(StepBudget, IsChargedForTheAnalysisOfAGraph) {
  constexpr int kWidth = 8, kHeight = 6;
  const Scene wall = test::Wall(kWidth, kHeight);
  Settings settings = test::AlwaysSteps(30);
  settings.path = Path::kFast;
  Solver solver(settings);
  const Report first = test::Solve(&solver, wall).report;
  const Report again = test::Solve(&solver, wall).report;
  ASSERT_GT(first.factorisations, 0);
  ASSERT_EQ(first.factorisations, again.factorisations);
  EXPECT_GT(first.work, again.work + 100 * kWidth * kHeight);
}

// A hundredfold weight on a chain, and ten courses of bricks. Sweeps are measured in the second
// frame at the latest.
TEST(StepBudget, IsSpentOnStepsWhereSweepsAreSlow) {
  constexpr int kFrames = 30;
  for (const Scene& scene : {test::Wall(10, 10), test::HangingChain(64, 100)}) {
    const auto steps = Frames(scene, kFrames, 250, 2), sweeps = Frames(scene, kFrames, 250, 0);
    for (int frame = 2; frame < kFrames; ++frame) {
      EXPECT_GT(steps[frame].report.steps_accepted, 0) << frame;
      EXPECT_LT(steps[frame].report.residual_energy, 0.5 * sweeps[frame].report.residual_energy)
          << frame;
    }
  }
}

// What was learnt decides, and is the same whoever did the work.
TEST(StepBudget, IsSpentAlikeForAnyNumberOfThreads) {
  const Scene scene = test::Together({test::Wall(20, 12), test::Wall(10, 10), test::Tower(30)});
  ASSERT_GT(scene.rows.size(), 4096u);
  const auto one = Frames(scene, 6, 300, 2, 1), three = Frames(scene, 6, 300, 2, 3);
  EXPECT_GT(one.back().report.steps_accepted, 0);
  EXPECT_TRUE(test::SameBits(one, three));
}

}  // namespace
}  // namespace cairn
