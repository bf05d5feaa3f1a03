// SPDX-License-Identifier: MIT
// Steps or sweeps: the better one runs, and the other one is looked at now and then.
#include "subspace/step_choice.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace cairn {
namespace {

/// What the choice was in each of so many frames; @p gain: of a frame with steps, or without.
std::vector<bool> Play(StepChoice* choice, int frames,
                       const std::function<double(bool steps)>& gain) {
  std::vector<bool> steps;
  for (int frame = 0; frame < frames; ++frame) {
    steps.push_back(choice->steps());
    choice->Learn(steps.back(), gain(steps.back()));
  }
  return steps;
}

int Count(const std::vector<bool>& steps, size_t begin, size_t end) {
  int count = 0;
  for (size_t i = begin; i < end; ++i) count += steps[i] ? 1 : 0;
  return count;
}

TEST(StepChoice, TriesBothOnceAndKeepsTheBetterOne) {
  StepChoice steps_pay, sweeps_pay;
  const auto with = Play(&steps_pay, 10, [](bool taken) { return taken ? 2.0 : 1.0; });
  const auto without = Play(&sweeps_pay, 10, [](bool taken) { return taken ? 1.0 : 2.0; });
  EXPECT_TRUE(with[0] && without[0]) << "steps first";
  EXPECT_FALSE(with[1] || without[1]);
  EXPECT_EQ(Count(with, 2, 10), 8);
  EXPECT_EQ(Count(without, 2, 10), 0);
}

TEST(StepChoice, LooksAtTheLoserEverMoreRarely) {
  StepChoice choice;
  const auto steps = Play(&choice, 3000, [](bool taken) { return taken ? 1.0 : 2.0; });
  EXPECT_GE(Count(steps, 2, 200), 3);
  EXPECT_LE(Count(steps, 2, 200), 6);
  EXPECT_GE(Count(steps, 2000, 3000), 2);
  EXPECT_LE(Count(steps, 2000, 3000), 5);
}

TEST(StepChoice, ChangesSidesWhenTheSceneDoes) {
  StepChoice choice;
  (void)Play(&choice, 100, [](bool taken) { return taken ? 1.0 : 2.0; });
  const auto steps = Play(&choice, 300, [](bool taken) { return taken ? 9.0 : 2.0; });
  EXPECT_GE(Count(steps, 200, 300), 95);
}

TEST(StepChoice, LearnsNothingOfStepsFromAFrameWithout) {
  StepChoice choice;
  for (int frame = 0; frame < 5; ++frame) {
    EXPECT_TRUE(choice.steps());
    choice.Learn(false, 1);
  }
}

}  // namespace
}  // namespace cairn
