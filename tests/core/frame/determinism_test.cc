// SPDX-License-Identifier: MIT
// The same bits for any number of threads, wherever they come from, on every instruction set, with
// every compiler.
#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using test::Coloured;
using test::Scene;
using test::Solution;

constexpr int kFrames = 20;
/// Problems of fewer rows stay on one thread (kParallelRows, block_solver.cc).
constexpr size_t kParallelRows = 4096;

/// A job system that starts a thread for each task.
class OwnThreads final : public Executor {
 public:
  ~OwnThreads() override {
    for (std::thread& thread : threads_) thread.join();
  }
  void Submit(void (*work)(void*), void* what) override {
    threads_.emplace_back(work, what);
    ++tasks;
  }
  int tasks = 0;

 private:
  std::vector<std::thread> threads_;
};

Scene SmallHeap() {
  return test::WithEveryLaw(test::Heap({.bodies = 60, .contacts = 150, .pins = 20}, 1), 1);
}

Scene LargeHeap() {
  const test::PileOptions options{.bodies = 800, .contacts = 1900, .pins = 150, .world_share = 0.3};
  return test::WithEveryLaw(test::Heap(options, 2), 2);
}

Scene LargeWall() { return test::NormalsFirst(test::Wall(18, 17)); }

Scene ManyIslands() {
  std::vector<Scene> parts(40, test::HangingChain(8, 3));
  for (int i = 0; i < 12; ++i) parts.push_back(test::Wall(3 + i % 3, 5));
  parts.push_back(test::Plate(50));
  return test::Together(parts);
}

size_t FewestRows(const std::vector<Solution>& solutions) {
  size_t rows = solutions[0].x.size();
  for (const Solution& solution : solutions) rows = std::min(rows, solution.x.size());
  return rows;
}

void ExpectSameBitsEverywhere(const Scene& scene, Settings settings, int frames) {
  settings.threads = 1;
  const std::vector<Solution> expected = test::Play(settings, scene, frames);
  for (const int threads : {2, 3, 8}) {
    settings.threads = threads;
    EXPECT_TRUE(test::SameBits(test::Play(settings, scene, frames), expected)) << threads;
    OwnThreads executor;
    settings.executor = &executor;
    EXPECT_TRUE(test::SameBits(test::Play(settings, scene, frames), expected)) << threads;
    EXPECT_EQ(executor.tasks > 0, FewestRows(expected) >= kParallelRows);
    settings.executor = nullptr;
  }
  for (const simd::Target target : simd::SupportedTargets()) {
    const test::AskFor asked(target);
    for (const int threads : {1, 2}) {
      settings.threads = threads;
      EXPECT_TRUE(test::SameBits(test::Play(settings, scene, frames), expected))
          << simd::TargetName(target);
    }
  }
}

TEST(Determinism, OfSweepsHoldsForSmallProblems) {
  ExpectSameBitsEverywhere(SmallHeap(), Coloured(8), kFrames);
  ExpectSameBitsEverywhere(test::Wall(6, 6), Coloured(8), kFrames);
}

TEST(Determinism, OfSweepsHoldsForProblemsThatThreadsShare) {
  for (const Scene& scene : {LargeHeap(), LargeWall()}) {
    EXPECT_GE(FewestRows(test::Play(Coloured(1), scene, kFrames)), kParallelRows);
    ExpectSameBitsEverywhere(scene, Coloured(8), kFrames);
  }
}

TEST(Determinism, OfSweepsThatEndIslandByIslandHolds) {
  Settings settings = Coloured(40);
  settings.tolerance = 1e-3;
  ExpectSameBitsEverywhere(ManyIslands(), settings, kFrames);
}

TEST(Determinism, OfStepsHolds) {
  ExpectSameBitsEverywhere(SmallHeap(), test::ColouredSteps(15), kFrames);
  Settings settings = test::ColouredSteps(15);
  settings.step_policy = StepPolicy::kMeasured;
  settings.tolerance = 1e-3;
  ExpectSameBitsEverywhere(ManyIslands(), settings, kFrames);
  ExpectSameBitsEverywhere(LargeWall(), settings, 6);
}

// What a budget of work leaves is a function of the problem, too.
TEST(Determinism, OfWorkBudgetsHolds) {
  Settings settings = Coloured(1000);
  for (const int work : {9000, 30000}) {
    settings.budget = Budget::Work(work);
    ExpectSameBitsEverywhere(LargeWall(), settings, 5);
  }
}

TEST(Determinism, OfSubstepsHolds) {
  Settings settings = test::ColouredSteps(10);
  settings.substeps = 3;
  ExpectSameBitsEverywhere(SmallHeap(), settings, 10);
  ExpectSameBitsEverywhere(ManyIslands(), settings, 5);
  ExpectSameBitsEverywhere(LargeWall(), settings, 3);
}

/// A scene and what 20 frames of it hash to. Not a truth: a way for machines and compilers to say
/// whether they agree.
struct Golden {
  std::string what;
  Scene scene;
  Settings settings;
  std::uint64_t hash;
};

TEST(Determinism, HoldsFromMachineToMachine) {
  Settings held = Coloured(8), relaxed = Coloured(8), converged = Coloured(60);
  held.tuning.lifted_friction = detail::LiftedFriction::kHold;
  relaxed.method = Method::kPsor;
  relaxed.tuning.omega = 1.2;
  converged.tolerance = 1e-3;
  Settings as_it_comes, work = test::ColouredSteps(1000);
  as_it_comes.max_sweeps = 10;
  work.step_policy = StepPolicy::kMeasured;
  work.budget = Budget::Work(40000);
  const std::vector<Golden> goldens = {
      {"tower", test::Tower(12), Coloured(8), 0x1fd511d08831adadu},
      {"small heap", SmallHeap(), Coloured(8), 0x2a1557f51619a780u},
      {"small heap, held", SmallHeap(), held, 0x3e379fefa3e9a818u},
      {"small heap, relaxed", SmallHeap(), relaxed, 0x2fc4d2e70089331au},
      {"large heap", LargeHeap(), Coloured(8), 0xd449bbf3af364323u},
      {"large wall", LargeWall(), Coloured(8), 0x7b31cd24d559d0deu},
      {"plate", test::Plate(60), Coloured(8), 0x7378896503dbbb02u},
      {"islands", ManyIslands(), converged, 0x30a254a49edb9e6du},
      {"tower, as it comes", test::Tower(12), as_it_comes, 0x75114ced24a0f90du},
      {"chain, as it comes", test::HangingChain(20, 50), as_it_comes, 0x106058fc5d5d085du},
      {"small heap, as it comes", SmallHeap(), as_it_comes, 0x5ca0075de41d5a5au},
      {"islands, as they come", ManyIslands(), as_it_comes, 0x4e761a11e48f4f22u},
      {"large wall, steps", LargeWall(), test::ColouredSteps(15), 0xd4cf277e62fac1d0u},
      {"islands, work", ManyIslands(), work, 0x17dccbef77664ca2u},
  };
  for (const Golden& golden : goldens) {
    const std::uint64_t hash = test::HashOf(test::Play(golden.settings, golden.scene, kFrames));
    EXPECT_EQ(hash, golden.hash) << golden.what << std::hex << ": 0x" << hash << "u";
  }
}

}  // namespace
}  // namespace cairn
