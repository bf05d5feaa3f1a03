// SPDX-License-Identifier: MIT
#include "verify/answers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/simd/ask_for.h"
#include "verify/plain_world.h"

namespace cairn::verify {
namespace {

std::vector<std::string> Descriptions(const std::vector<Difference>& differences) {
  std::vector<std::string> lines;
  for (const Difference& difference : differences) lines.push_back(Describe(difference));
  return lines;
}

const Answer kTower{"core/tower", {1, 0xfedcba9876543210u, 3}};

TEST(Answers, AreLinesAndBack) {
  EXPECT_EQ(ToLine(kTower), "core/tower 0000000000000001 fedcba9876543210 0000000000000003");
  EXPECT_EQ(FromLine(ToLine(kTower)), kTower);
}

TEST(Answers, ThatDifferNameTheFirstFrames) {
  const std::vector<Answer> golden = {kTower, {"core/wall", {4, 5, 6}}, {"core/old", {7}}};
  const std::vector<Answer> now = {
      {"core/tower", {1, 2, 3}}, {"core/wall", {4, 5, 6}}, {"core/new", {7}}};
  EXPECT_THAT(Descriptions(Compare(golden, now)),
              testing::ElementsAre("core/tower: differs in frames 31 to 60",
                                   "core/new: is in one of the lists alone",
                                   "core/old: is in one of the lists alone"));
  EXPECT_TRUE(Compare(golden, golden).empty());
}

// Else the golden hashes would be those of a heap that no solver could get wrong.
TEST(PlainWorldTest, KeepsATowerUp) {
  PlainWorld world(Settings{});
  for (int i = 0; i < 8; ++i) {
    world.things.push_back({.mass = 1, .half = {0.5, 0.5, 0.5}, .position = {0, 0.5 + i, 0}});
  }
  for (int frame = 0; frame < kFrames; ++frame) world.Step();
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(world.things[i].position.y(), 0.5 + i, 0.05) << i;
}

TEST(PlainWorldTest, KeepsAPendulumOnItsPin) {
  PlainWorld world(Settings{});
  world.things.push_back({.mass = 1, .half = {0.5, 0.1, 0.1}, .position = {0.5, 5, 0}});
  world.pins.push_back({0, -1, {-0.5, 0, 0}, {0, 5, 0}});
  double lowest = 5;
  for (int frame = 0; frame < kFrames; ++frame) {
    world.Step();
    const Thing& rod = world.things[0];
    const Eigen::Vector3d end = rod.position - 0.5 * rod.turn.Axes().col(0);
    EXPECT_LT((end - Eigen::Vector3d(0, 5, 0)).norm(), 0.05);
    lowest = std::min(lowest, rod.position.y());
  }
  EXPECT_NEAR(lowest, 4.5, 0.05);
}

TEST(Golden, AnswersOfTheCoreAreThoseOfEveryTarget) {
  for (const simd::Target target : simd::SupportedTargets()) {
    const test::AskFor asked(target);
    EXPECT_THAT(Descriptions(Compare(GoldenCoreAnswers(), CoreAnswers())), testing::IsEmpty())
        << simd::TargetName(target);
  }
}

}  // namespace
}  // namespace cairn::verify
