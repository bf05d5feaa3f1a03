// SPDX-License-Identifier: MIT
#include "cairn/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <span>
#include <string_view>

#include "cairn/solver.h"

namespace cairn {
namespace {

TEST(Describe, SaysSomethingElseForEveryStatus) {
  std::set<std::string_view> sentences;
  for (int i = 0; i <= static_cast<int>(Status::kOverflow); ++i) {
    const std::string_view sentence = Describe(static_cast<Status>(i));
    EXPECT_GT(sentence.size(), 10u) << i;
    EXPECT_NE(sentence.back(), '.') << sentence;
    EXPECT_TRUE(sentences.insert(sentence).second) << sentence;
  }
  EXPECT_EQ(sentences.count("unknown status"), 0u);
}

TEST(Describe, SaysSomethingElseForEveryStopReason) {
  std::set<std::string_view> words;
  for (int i = 0; i <= static_cast<int>(StopReason::kWorkSpent); ++i) {
    const std::string_view word = Describe(static_cast<StopReason>(i));
    EXPECT_GT(word.size(), 5u) << i;
    EXPECT_TRUE(words.insert(word).second) << word;
  }
  EXPECT_EQ(words.count("unknown reason"), 0u);
}

TEST(Describe, SaysSomethingElseForEveryReasonNotToStep) {
  std::set<std::string_view> words;
  for (int i = 0; i <= static_cast<int>(NoStep::kSweepsFaster); ++i) {
    const std::string_view word = Describe(static_cast<NoStep>(i));
    EXPECT_GT(word.size(), 5u) << i;
    EXPECT_TRUE(words.insert(word).second) << word;
  }
  EXPECT_EQ(words.count("unknown reason"), 0u);
}

TEST(Describe, AnswersNumbersThatAreNoStatus) {
  EXPECT_EQ(Describe(static_cast<Status>(99)), "unknown status");
  EXPECT_EQ(Describe(static_cast<StopReason>(99)), "unknown reason");
  EXPECT_EQ(Describe(static_cast<NoStep>(99)), "unknown reason");
}

/// A ball of 2 kg that falls on the ground at 4 m/s, solved from rest.
IslandReport OfFallingBall(Settings settings) {
  Body ball;
  ball.inv_mass = 0.5;
  ball.velocity.linear = {0, 0, -4};
  const Row contact{.body_a = 0, .linear_a = {0, 0, 1}, .lo = 0};
  double impulse = 0;
  Velocity velocity;
  Solver solver(settings);
  const Report report =
      solver.Solve({{&ball, 1}, {&contact, 1}}, {std::span(&impulse, 1)}, {&velocity, 1});
  EXPECT_TRUE(report.ok());
  EXPECT_EQ(report.islands.size(), 1U);
  return report.islands.at(0);
}

TEST(IslandReport, SaysHowFarTheStartWasFromTheSolution) {
  for (Path path : {Path::kFast, Path::kReference}) {
    const IslandReport island = OfFallingBall({.path = path});
    EXPECT_FLOAT_EQ(island.residual_before.max, 4);
    EXPECT_FLOAT_EQ(island.residual_before.energy, 4 * std::sqrt(2.0));
    EXPECT_EQ(island.residual_before.max_angular, 0);
    EXPECT_LT(island.residual.max, 1e-6);
  }
}

TEST(IslandReport, OfNoSweepsIsAsFarAfterAsBefore) {
  for (Path path : {Path::kFast, Path::kReference}) {
    const IslandReport island = OfFallingBall({.path = path, .max_sweeps = 0});
    EXPECT_FLOAT_EQ(island.residual.max, 4);
    EXPECT_EQ(island.residual_before.max, island.residual.max);
    EXPECT_EQ(island.residual_before.energy, island.residual.energy);
  }
}

}  // namespace
}  // namespace cairn
