// SPDX-License-Identifier: MIT
// What a frame knows of its islands: where each is, how far sweeps came, and which groups go on.
#include "cycle/cycle_islands.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

TEST(IslandProgress, IsJudgedAfterAStepAndThenSweptBeforeTheNextOne) {
  IslandProgress island;
  EXPECT_TRUE(island.open());
  EXPECT_TRUE(island.MayStep());
  island.Step();
  EXPECT_TRUE(island.stepped());
  EXPECT_FALSE(island.open()) << "it is to be compared with itself first";
  EXPECT_FALSE(island.MayStep());
  island.Judge();
  EXPECT_TRUE(island.open());
  EXPECT_FALSE(island.MayStep()) << "a round of sweeps alone";
  EXPECT_TRUE(island.MayStep());
}

TEST(IslandProgress, TakesNoStepOnceItIsDoneOrItIsTooLate) {
  IslandProgress late;
  late.EndSteps();
  EXPECT_FALSE(late.MayStep());
  EXPECT_TRUE(late.open()) << "sweeps go on";

  IslandProgress done;
  done.Step();
  done.Judge();
  done.Stop();
  EXPECT_TRUE(done.done());
  EXPECT_FALSE(done.open());
  EXPECT_FALSE(done.MayStep());
  EXPECT_FALSE(done.MayStep());
}

TEST(SweepRun, KeepsTheFirstMarkAndTwoThatAreEachTwiceAsFar) {
  SweepRun run;
  const auto energy = [](int sweeps) { return 100.0 / sweeps; };
  for (int sweeps = 3; sweeps <= 30; ++sweeps) run.See(sweeps, energy(sweeps));
  EXPECT_EQ(run.begin, 0);
  EXPECT_EQ(run.start.sweeps, 3);
  EXPECT_EQ(run.quarter.sweeps, 12);
  EXPECT_EQ(run.half.sweeps, 24);
  EXPECT_EQ(run.half.energy, energy(24));

  run.Begin(28, 30, energy(30));
  EXPECT_EQ(run.start.sweeps, 2);
  run.See(32, energy(32));
  EXPECT_EQ(run.half.sweeps, 4);
  EXPECT_EQ(run.quarter.sweeps, 2);
}

/// Two towers, which share the lanes of one group.
struct TwoIslands {
  Plan plan;
  CycleIslands islands;

  TwoIslands() {
    test::MakePlan(test::Together({test::Wall(1, 3), test::Wall(1, 5)}), 1, &plan);
    islands.Begin(plan, NoStep::kEnded);
  }
};

TEST(CycleIslands, SweepAGroupUntilAllOfItsIslandsAreDone) {
  TwoIslands two;
  ASSERT_EQ(two.islands.count(), 2);
  ASSERT_EQ(two.plan.groups().size(), 1u);
  two.islands.groups()[0].sweeps = 7;
  EXPECT_EQ(two.islands.SweepsMade(), 7);
  EXPECT_EQ(two.islands.ActiveRows(), static_cast<double>(two.plan.groups()[0].rows));

  std::vector<int> kept;
  const auto keep = [&](int island) { kept.push_back(island); };
  two.islands.Stop(1, StopReason::kConverged);
  two.islands.CloseGroups(keep);
  EXPECT_EQ(kept, std::vector<int>{1}) << "its lanes go on with those of the other";
  EXPECT_TRUE(two.islands.active());
  EXPECT_EQ(two.islands.report(1).stop, StopReason::kConverged);
  EXPECT_EQ(two.islands.report(1).sweeps, 7);
  EXPECT_EQ(two.islands.report(0).no_step, NoStep::kEnded);

  two.islands.Stop(0, StopReason::kSweepLimit);
  two.islands.CloseGroups(keep);
  EXPECT_EQ(kept.size(), 1u) << "nothing moves it any more";
  EXPECT_FALSE(two.islands.active());
  EXPECT_EQ(two.islands.ActiveRows(), 0);
}

TEST(CycleIslands, BeginANewFrameAsIfThereWasNoneBefore) {
  TwoIslands two;
  two.islands.groups()[0].sweeps = 7;
  two.islands[0].EndSteps();
  two.islands.Stop(0, StopReason::kWorkSpent);
  two.islands.Stop(1, StopReason::kWorkSpent);
  two.islands.Begin(two.plan, NoStep::kNotAsked);
  EXPECT_TRUE(two.islands.active());
  EXPECT_EQ(two.islands.SweepsMade(), 0);
  EXPECT_TRUE(two.islands[0].MayStep());
  EXPECT_EQ(two.islands.report(0).stop, StopReason::kNotStarted);
  two.islands.CloseGroups([](int) { FAIL() << "nothing has stopped in this frame"; });
}

TEST(GroupChoice, IsOfWholeGroups) {
  TwoIslands two;
  GroupChoice choice;
  choice.Begin(two.plan);
  EXPECT_FALSE(choice.Has(0));
  EXPECT_EQ(choice.Rows(), 0);
  choice.Add(1);
  EXPECT_TRUE(choice.Has(0)) << "they share lanes";
  EXPECT_GT(choice.Rows(), 0);
  choice.Clear();
  EXPECT_FALSE(choice.Has(1));
  choice.AddAll();
  EXPECT_TRUE(choice.Has(1));
}

}  // namespace
}  // namespace cairn
