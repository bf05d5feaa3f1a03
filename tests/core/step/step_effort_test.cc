// SPDX-License-Identifier: MIT
// StepPolicy::kWeighed: a step or sweeps in its place, on each island by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using test::Scene;
using test::Solution;

constexpr int kSweeps = 10;

Settings Weighed() {
  Settings settings;
  settings.path = Path::kFast;
  settings.step_policy = StepPolicy::kWeighed;
  settings.max_sweeps = kSweeps;
  settings.tolerance = 0;
  return settings;
}

/// The same scene from rest, frame after frame by one solver, which learns.
std::vector<Solution> Frames(const Settings& settings, const Scene& scene, int frames) {
  Solver solver(settings);
  std::vector<Solution> solutions;
  for (int frame = 0; frame < frames; ++frame) solutions.push_back(test::Solve(&solver, scene));
  return solutions;
}

TEST(Effort, IsSweepsOrAStepAndNeverMoreThanTwiceTheSweeps) {
  bool steps = false, sweeps = false;
  for (const Scene& scene : {test::Wall(12, 8), test::Wall(1, 12), test::Plate(30)}) {
    for (const Solution& solution : Frames(Weighed(), scene, 40)) {
      for (const IslandReport& island : solution.report.islands) {
        EXPECT_GE(island.sweeps, kSweeps);
        EXPECT_LE(island.sweeps, island.steps_accepted > 0 ? kSweeps : 2 * kSweeps);
        steps = steps || island.steps_accepted > 0;
        sweeps = sweeps || island.sweeps > kSweeps;
      }
    }
  }
  EXPECT_TRUE(steps) << "a tower of twelve needs them";
  EXPECT_TRUE(sweeps) << "a wall of two hundred rows has room for more";
}

// The same problem every time: whether a step is tried and undone makes no difference to the bits.
// Sweeps in its place were plain ones, and no more than ten, so that what rests was pushed.
TEST(Effort, AStepThatIsUndoneLeavesWhatSweepsAloneMake) {
  const Scene wall = test::Wall(12, 8), plate = test::Plate(30);
  int undone = 0;
  for (const Scene& scene : {wall, plate, test::Together({wall, plate, test::Wall(4, 3)})}) {
    Solution alone;
    int since_step = 0;  // frames, until when a start may be softened
    for (const Solution& solution : Frames(Weighed(), scene, 300)) {
      bool stepped = false, tried = false;
      for (const IslandReport& island : solution.report.islands) {
        stepped = stepped || island.steps_accepted > 0;
        tried = tried || island.steps_restored > 0;
      }
      since_step = stepped ? 0 : since_step + 1;
      if (since_step < 100) continue;
      if (alone.x.empty() && !tried) alone = solution;
      if (alone.x.empty() || !tried) continue;
      ++undone;
      EXPECT_TRUE(test::SameBits(solution, alone));
    }
  }
  EXPECT_GE(undone, 5);
}

TEST(Effort, WithoutStepsIsPlainlyTheSweepsAskedFor) {
  Settings settings = Weighed();
  settings.k_sm = 0;
  for (const Solution& solution : Frames(settings, test::Wall(12, 8), 3)) {
    EXPECT_EQ(solution.report.sweeps, kSweeps);
  }
}

TEST(Effort, OfNoSweepsIsNone) {
  Settings settings = Weighed();
  settings.max_sweeps = 0;
  const Solution solution = test::Solve(settings, test::Wall(3, 3));
  EXPECT_EQ(solution.report.sweeps, 0);
  EXPECT_EQ(solution.report.factorisations, 0);
}

// Each island has an allowance of its own: who else is in the problem changes nothing.
TEST(Effort, OfAnIslandDoesNotSeeTheOthers) {
  const std::vector<Scene> alone = {test::Wall(1, 12), test::Wall(6, 4), test::Wall(1, 3)};
  const std::vector<Solution> together = Frames(Weighed(), test::Together(alone), 30);
  size_t first = 0;
  for (const Scene& scene : alone) {
    const std::vector<Solution> single = Frames(Weighed(), scene, 30);
    for (size_t frame = 0; frame < single.size(); ++frame) {
      for (size_t body = 0; body < scene.bodies.size(); ++body) {
        EXPECT_EQ(together[frame].v[first + body].linear, single[frame].v[body].linear)
            << "frame " << frame << ", body " << body;
      }
    }
    first += scene.bodies.size();
  }
}

}  // namespace
}  // namespace cairn
