// SPDX-License-Identifier: MIT
// What an island remembers of steps that a guard undid.
#include "step/island_memory.h"

#include <gtest/gtest.h>

#include "cairn/settings.h"

namespace cairn {
namespace {

const Settings kSettings;

double Joints(const IslandMemory& memory) { return memory.Step(kSettings).proximal_joints; }

void Guard(IslandMemory* memory, int times) {
  for (int i = 0; i < times; ++i) memory->Guarded();
}

void Keep(IslandMemory* memory, int steps) {
  for (int i = 0; i < steps; ++i) memory->Accepted();
}

/// How often it is not due.
int Pause(IslandMemory* memory) {
  int left_out = 0;
  while (!memory->Due(kSettings)) ++left_out;
  return left_out;
}

TEST(IslandMemory, LeavesStepsOutAfterAGuardForLongerEachTime) {
  IslandMemory memory;
  const auto pause = [&memory] {
    memory.Guarded();
    return Pause(&memory);
  };
  const int first = pause(), second = pause();
  EXPECT_GT(first, 0);
  EXPECT_EQ(second, 2 * first);
  memory.Accepted();
  EXPECT_EQ(pause(), first);
}

// Sweeps alone would let go what it held for many frames, and the next step catch it with a jerk.
TEST(IslandMemory, TriesAtOnceAgainWhereOneStepAmongManyIsLost) {
  constexpr int kMany = 8;
  IslandMemory memory;
  const auto end = [&memory](bool kept) {
    if (kept) {
      memory.Accepted();
    } else {
      memory.Restored();
    }
    memory.EndSolve(kept, true);
  };
  for (int i = 0; i < kMany - 1; ++i) end(true);
  end(false);
  EXPECT_EQ(Pause(&memory), 1) << "not many yet";
  for (int i = 0; i < kMany; ++i) end(true);
  end(false);
  EXPECT_EQ(Pause(&memory), 0);
  end(false);
  EXPECT_EQ(Pause(&memory), 2) << "twice in a row";
}

// A taut bridge that has opened closes by being flung, as long as its pins are hard.
TEST(IslandMemory, SoftensJointsWhereGuardsUndoOneStepAfterTheOther) {
  IslandMemory memory;
  Guard(&memory, 2);
  EXPECT_EQ(Joints(memory), kSettings.proximal_joints);
  Guard(&memory, 1);
  EXPECT_DOUBLE_EQ(Joints(memory), 10 * kSettings.proximal_joints);
  Guard(&memory, 1);
  EXPECT_DOUBLE_EQ(Joints(memory), 100 * kSettings.proximal_joints);
  Guard(&memory, 1000);
  EXPECT_LE(Joints(memory), 1e-3);
}

TEST(IslandMemory, HardensJointsAgainWhileStepsAreKept) {
  IslandMemory memory;
  Guard(&memory, 4);
  Keep(&memory, 7);
  EXPECT_DOUBLE_EQ(Joints(memory), 100 * kSettings.proximal_joints);
  Keep(&memory, 1);
  EXPECT_DOUBLE_EQ(Joints(memory), 10 * kSettings.proximal_joints);
  Keep(&memory, 8);
  EXPECT_EQ(Joints(memory), kSettings.proximal_joints);
}

TEST(IslandMemory, SoftensNothingWhereAStepWasKeptBetween) {
  IslandMemory memory;
  for (int i = 0; i < 10; ++i) {
    Guard(&memory, 2);
    Keep(&memory, 1);
  }
  EXPECT_EQ(Joints(memory), kSettings.proximal_joints);
}

TEST(IslandMemory, LeavesJointsAsSoftAsTheyAreSet) {
  IslandMemory memory;
  Settings soft;
  soft.proximal_joints = 0.1;
  Guard(&memory, 10);
  EXPECT_EQ(memory.Step(soft).proximal_joints, 0.1);
}

}  // namespace
}  // namespace cairn
