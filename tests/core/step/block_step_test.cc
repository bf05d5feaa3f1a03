// SPDX-License-Identifier: MIT
// The step on blocks against the step in double precision on rows (step_test.cc compares that one
// with dense algebra).
#include "step/block_step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "pack/block_frame.h"
#include "reference/step.h"
#include "tests/core/support/block_problems.h"
#include "tests/core/support/packed.h"

namespace cairn {
namespace {

using test::Packed;
using test::Scene;

constexpr StepSettings kSettings = {
    .proximal = 3e-3, .proximal_joints = 1e-4, .factorisations = 2, .refinements = 2};

/// A scene in blocks, from given impulses.
struct Blocks {
  const Scene& scene;
  BlockFrame frame;
  Crew crew;
  std::vector<IslandStep> islands;
  std::vector<double> x;
  std::vector<Velocity> v;

  Blocks(const Scene& of, std::vector<double> start, int threads = 1)
      : scene(of), crew(threads), x(std::move(start)), v(of.bodies.size()) {
    EXPECT_EQ(frame.Begin(scene.problem(), 1, {.rows = x}, &crew), PackResult::kDone);
    islands.assign(frame.plan().islands().size(), {.taken = true,
                                                   .proximal = kSettings.proximal,
                                                   .proximal_joints = kSettings.proximal_joints});
  }

  template <class T>
  void Take(const StepSettings& settings = kSettings) {
    BlockSystem<T> system(frame.target());
    BlockStep<T> step(frame.target());
    for (IslandStep& island : islands) island.factorisations = settings.factorisations;
    for (int group = 0; group < static_cast<int>(frame.plan().groups().size()); ++group) {
      if (!system.Recognise(frame.plan(), 1, group)) system.Analyse(frame.plan());
      step.Take(frame.plan(), group, settings.refinements, &system, &crew, &frame.blocks(),
                islands);
    }
    frame.End(scene.problem(), &crew, {.rows = x}, v);
  }
};

/// Impulses after some sweeps, as floats have them.
std::vector<double> Swept(const Scene& scene, int sweeps) {
  std::vector<double> x = test::Solve(test::PlainSweeps(sweeps), scene).x;
  for (double& number : x) number = static_cast<double>(static_cast<float>(number));
  return x;
}

/// Largest difference of the two steps, relative to the largest impulse.
template <class T>
double StepError(const Scene& scene, int sweeps) {
  const std::vector<double> start = Swept(scene, sweeps);
  Packed packed(scene, 0);
  packed.state.x.assign(start.begin(), start.end());
  RecomputeVelocities(packed.island, &packed.state);
  BodySystem system;
  system.Prepare(packed.island);
  const StepResult expected = TakeStep(packed.island, kSettings, &system, &packed.state);

  Blocks blocks(scene, start);
  blocks.Take<T>();
  EXPECT_TRUE(expected.solved && blocks.islands[0].result.solved);
  EXPECT_EQ(blocks.islands[0].result.factorisations, expected.factorisations);
  double largest = 0, error = 0;
  for (size_t i = 0; i < start.size(); ++i) {
    largest = std::max(largest, std::abs(packed.state.x[i]));
    error = std::max(error, std::abs(packed.state.x[i] - blocks.x[i]));
  }
  return error / largest;
}

// Rows are rounded to floats, and divided by eps = 3e-3.
TEST(BlockStep, IsThatOfRowsInDoublePrecision) {
  EXPECT_LT(StepError<double>(test::Tower(4), 20), 1e-4);
  EXPECT_LT(StepError<double>(test::Tower(30), 20), 1e-3);
  EXPECT_LT(StepError<double>(test::HangingChain(12, 30), 20), 1e-3);
  EXPECT_LT(StepError<double>(test::Wall(6, 6), 30), 1e-3);
}

TEST(BlockStep, InSinglePrecisionIsCloseForContacts) {
  EXPECT_LT(StepError<float>(test::Tower(4), 20), 1e-3);
  EXPECT_LT(StepError<float>(test::Tower(30), 20), 5e-3);
  EXPECT_LT(StepError<float>(test::Wall(6, 6), 30), 5e-3);
}

TEST(BlockStep, LeavesVelocitiesThatBelongToItsImpulses) {
  const Scene scene = test::Wall(8, 8);
  Blocks blocks(scene, Swept(scene, 10));
  blocks.Take<float>();
  Blocks again(scene, blocks.x);
  again.frame.End(scene.problem(), &again.crew, {.rows = again.x}, again.v);
  EXPECT_EQ(blocks.x, again.x);
  EXPECT_LT(test::Distance(blocks.v, again.v), 1e-5);
}

TEST(BlockStep, KeepsImpulsesInsideTheirBounds) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Scene scene = test::WithEveryLaw(
        test::Heap({.bodies = 60, .contacts = 200, .pins = 20, .world_share = 0.3}, seed), seed);
    Blocks blocks(scene, Swept(scene, 10));
    blocks.Take<double>();
    for (size_t i = 0; i < blocks.x.size(); ++i) {
      const Row& row = scene.rows[i];
      const double most =
          row.parent == kNoRow ? kInfinity : row.friction * std::max(0.0, blocks.x[row.parent]);
      const double room = 1e-6 * (1 + std::abs(blocks.x[i]));
      EXPECT_GE(blocks.x[i], std::max(row.lo, -most) - room);
      EXPECT_LE(blocks.x[i], std::min(row.hi, most) + room);
    }
  }
}

// Islands that share lanes with those that take the step.
TEST(BlockStep, ChangesNothingOnIslandsThatDoNotTakeIt) {
  const Scene scene = test::Together({test::Tower(5), test::Tower(5), test::Tower(7)});
  const std::vector<double> start = Swept(scene, 10);
  Blocks untouched(scene, start), some(scene, start), all(scene, start);
  untouched.frame.End(scene.problem(), &untouched.crew, {.rows = untouched.x}, untouched.v);
  some.islands[1].taken = false;
  some.Take<float>();
  all.Take<float>();
  const size_t rows = test::Tower(5).rows.size();
  for (size_t i = 0; i < start.size(); ++i) {
    const bool second = i >= rows && i < 2 * rows;
    EXPECT_EQ(some.x[i], second ? untouched.x[i] : all.x[i]) << i;
  }
  for (int body = 5; body < 10; ++body) {
    EXPECT_EQ(some.v[body].linear, untouched.v[body].linear);
    EXPECT_EQ(some.v[body].angular, untouched.v[body].angular);
  }
  EXPECT_NE(all.x, untouched.x);
}

TEST(BlockStep, HasTheSameBitsOnEveryTargetAndForAnyNumberOfThreads) {
  const Scene scene = test::Wall(14, 14);
  const std::vector<double> start = Swept(scene, 10);
  const auto result = [&](simd::Target target, int threads) {
    const test::AskFor asked(target);
    Blocks blocks(scene, start, threads);
    blocks.Take<float>();
    return blocks.x;
  };
  const std::vector<double> expected = result(simd::Target::kScalar, 1);
  for (const simd::Target target : simd::SupportedTargets()) {
    for (const int threads : {1, 2, 8}) EXPECT_EQ(result(target, threads), expected);
  }
}

// A pattern is kept while the pairs of a frame are nearly all of those it was made for.
TEST(BlockSystem, IsAnalysedAgainOnlyWhereMuchHasChanged) {
  Scene scene = test::Wall(8, 7);
  Plan plan;
  test::MakePlan(scene, 1, &plan);
  BlockSystem<float> system(simd::BestTarget());
  EXPECT_FALSE(system.Recognise(plan, 1, 0));
  system.Analyse(plan);
  EXPECT_TRUE(system.Recognise(plan, 2, 0));

  Scene fewer = scene;  // the last brick loses one of its two faces
  fewer.rows.resize(fewer.rows.size() - 12);
  test::MakePlan(fewer, 1, &plan);
  EXPECT_TRUE(system.Recognise(plan, 3, 0));
  test::MakePlan(scene, 1, &plan);
  EXPECT_TRUE(system.Recognise(plan, 4, 0)) << "the pair is back";

  const int a = 0, b = 55;
  const Eigen::Vector3d point(0, 0, 0);
  test::AddContact(&scene, test::PointRow(scene, a, b, point, Eigen::Vector3d::UnitZ()), point,
                   0.5);
  test::MakePlan(scene, 1, &plan);
  EXPECT_FALSE(system.Recognise(plan, 5, 0)) << "a pair that it has no place for";
  EXPECT_FALSE(system.IsPreparedFor(5, 0));
  test::MakePlan(fewer, 1, &plan);
  EXPECT_TRUE(system.Recognise(plan, 6, 0)) << "what was not analysed is forgotten";
}

// An analysis is an investment: what graphs last decides whether it pays.
TEST(BlockSystem, ExpectsAsManyStepsOfAnAnalysisAsOthersServed) {
  Plan plan;
  BlockSystem<float> system(simd::BestTarget());
  const auto analyse = [&](int bricks, int number) {
    test::MakePlan(test::Wall(bricks, 3), 1, &plan);
    ASSERT_FALSE(system.Recognise(plan, number, 0));
    system.Analyse(plan);
  };
  const double at_first = system.steps_of_analysis();
  EXPECT_GT(at_first, 1);
  analyse(4, 1);
  EXPECT_EQ(system.steps_of_analysis(), at_first) << "nothing is known yet";
  for (int step = 0; step < 100; ++step) system.CountStep();
  EXPECT_EQ(system.steps_of_analysis(), 100) << "it serves";
  analyse(5, 2);
  EXPECT_NEAR(system.steps_of_analysis(), 50, 10);
  for (int number = 4; number < 20; ++number) analyse(4 + number % 2, number);
  EXPECT_NEAR(system.steps_of_analysis(), 1, 0.01) << "none of them served for long";
}

TEST(BlockSystem, KeepsAPlaceForPairsThatComeAndGo) {
  const Eigen::Vector3d point(0, 0, 0);
  const auto with_pair = [&](int a, int b) {
    Scene scene = test::Wall(8, 7);
    test::AddContact(&scene, test::PointRow(scene, a, b, point, Eigen::Vector3d::UnitZ()), point,
                     0.5);
    return scene;
  };
  const Scene scenes[] = {with_pair(0, 55), with_pair(7, 40)};
  Plan plan;
  BlockSystem<float> system(simd::BestTarget());
  for (int frame = 0; frame < 6; ++frame) {
    test::MakePlan(scenes[frame % 2], 1, &plan);
    EXPECT_EQ(system.Recognise(plan, frame, 0), frame >= 2) << frame;
    if (frame < 2) system.Analyse(plan);
  }
}

}  // namespace
}  // namespace cairn
