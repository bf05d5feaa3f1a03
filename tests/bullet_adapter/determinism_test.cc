// SPDX-License-Identifier: MIT
// Every scene for two seconds: the same bits on every instruction set and for any number of
// threads.
#include <gtest/gtest.h>

#include <cstdint>
#include <string_view>

#include "cairn/bullet/constraint_solver.h"
#include "tests/bullet_adapter/scene_world.h"
#include "tests/simd/ask_for.h"

namespace cairn::test {
namespace {

constexpr int kFrames = 120;

std::uint64_t HashAfter(std::string_view scene, simd::Target target, int threads) {
  const AskFor asked(target);
  bullet::ConstraintSolver solver(Settings{.method = Method::kPgs, .threads = threads});
  SceneWorld world(scene, &solver);
  world.Step(kFrames);
  EXPECT_TRUE(solver.report().ok());
  return bench::StateHash(world.world());
}

class BitsOfScene : public testing::TestWithParam<std::string_view> {};

TEST_P(BitsOfScene, DependNeitherOnTheTargetNorOnTheThreads) {
  const std::uint64_t expected = HashAfter(GetParam(), simd::BestTarget(), 1);
  for (const int threads : {2, 3, 8}) {
    EXPECT_EQ(HashAfter(GetParam(), simd::BestTarget(), threads), expected) << threads;
  }
  for (const simd::Target target : simd::SupportedTargets()) {
    EXPECT_EQ(HashAfter(GetParam(), target, 2), expected) << simd::TargetName(target);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, BitsOfScene, testing::ValuesIn(SceneNames()), SceneTestName());

}  // namespace
}  // namespace cairn::test
