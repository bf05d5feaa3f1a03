// SPDX-License-Identifier: MIT
// Steps or sweeps, from what both were seen to do.
#include "step/step_odds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

/// @p cut: logarithm of what every first step divides the residual by, further ones not at all
StepOdds Measured(double power, double cut) {
  StepOdds odds;
  odds.Expect(2);
  for (int frame = 0; frame < 100; ++frame) {
    odds.LearnSweeps(power);
    odds.LearnStep(0, std::exp(-cut));
    odds.LearnStep(1, 1);
    odds.EndFrame(1);
  }
  return odds;
}

// After k sweeps of n the power of n / k, by hand: a step that takes half of the sweeps left pays
// if it cuts more than 2 to the power, with half of them gone.
TEST(StepOdds, AskForThePricesThatSweepsWouldMakeUpFor) {
  EXPECT_NEAR(StepOdds::PricesLeft(std::log(2)), 2, 1e-12);
  EXPECT_NEAR(StepOdds::PricesLeft(std::log(1.25)), 5, 1e-12);
  EXPECT_NEAR(StepOdds::PricesLeft(50), 1, 1e-12);
  EXPECT_TRUE(std::isinf(StepOdds::PricesLeft(0)));
  EXPECT_TRUE(std::isinf(StepOdds::PricesLeft(-1)));
}

TEST(StepOdds, LearnThePowerOfSweepsAndTheCutOfSteps) {
  const StepOdds odds = Measured(1.5, 3);
  EXPECT_NEAR(odds.power(), 1.5, 1e-9);
  EXPECT_GT(odds.cut(0), 2.5);
  EXPECT_LT(odds.cut(0), 3) << "less a margin";
  EXPECT_LT(odds.cut(1), 0) << "those after the first are known by themselves";
}

TEST(StepOdds, ForgetWhatSceneThereWas) {
  StepOdds odds = Measured(1.5, 3);
  for (int frame = 0; frame < 20; ++frame) {
    odds.LearnSweeps(0.5);
    odds.LearnStep(0, 1);
  }
  EXPECT_NEAR(odds.power(), 0.5, 0.01);
  EXPECT_LT(odds.cut(0), 0);
}

// What did harm is tried again after some frames without, as if nothing were known.
TEST(StepOdds, FadeInFramesWithoutSteps) {
  StepOdds odds = Measured(1, -1), fresh;
  fresh.Expect(2);
  for (int frame = 0; frame < 20; ++frame) odds.EndFrame(0);
  EXPECT_LT(odds.cut(0), 0);
  for (int frame = 0; frame < 1000; ++frame) odds.EndFrame(0);
  EXPECT_NEAR(odds.cut(0), fresh.cut(0), 0.01);
}

TEST(StepOdds, WantAFrameWithoutStepsNowAndThen) {
  StepOdds odds;
  odds.EndFrame(1);
  EXPECT_TRUE(odds.stale()) << "nothing is known of sweeps";
  odds.LearnSweeps(0.5);
  int frames = 0;
  for (; !odds.stale() && frames < 1000; ++frames) odds.EndFrame(1);
  EXPECT_GE(frames, 50);
  EXPECT_LE(frames, 100);
  odds.EndFrame(1);
  EXPECT_TRUE(odds.stale());
  odds.EndFrame(0);
  EXPECT_FALSE(odds.stale());
}

TEST(StepOdds, TellALoadThatIsNotCarriedFromAHit) {
  StepOdds odds;
  const auto end_frames = [&odds](int frames, int stepped_bodies, bool gross) {
    for (int i = 0; i < frames; ++i) odds.EndFrame(stepped_bodies, gross);
  };
  end_frames(3, 0, true);
  end_frames(1, 0, false);
  end_frames(3, 0, true);
  EXPECT_FALSE(odds.stays_gross()) << "never for long";
  end_frames(1, 0, true);
  EXPECT_TRUE(odds.stays_gross());
  end_frames(100, 5, false);
  EXPECT_TRUE(odds.stays_gross()) << "frames with steps say nothing of sweeps";
  end_frames(1, 0, false);
  EXPECT_FALSE(odds.stays_gross());
}

// What gravity adds in a step, and what an arm of motors sinks by in each, is less in short ones.
TEST(StepOdds, ExpectLessOfShortSteps) {
  const auto stays_gross = [](double error, double time_step) {
    StepOdds odds;
    for (int frame = 0; frame < 4; ++frame) odds.EndFrame(0, error, time_step);
    return odds.stays_gross();
  };
  for (const double unknown_or_long : {0.0, 1 / 60.0, 1 / 30.0}) {
    EXPECT_FALSE(stays_gross(0.14, unknown_or_long));
    EXPECT_TRUE(stays_gross(0.16, unknown_or_long));
  }
  EXPECT_FALSE(stays_gross(0.035, 1 / 240.0));
  EXPECT_TRUE(stays_gross(0.04, 1 / 240.0));
  EXPECT_FALSE(stays_gross(0.002, 1e-9)) << "as if it were 1 / 3840 s";
}

// A rope that was left to sweeps meets a wall that takes steps: together they have not stepped.
TEST(StepOdds, KnowWhetherMostBodiesWereStepped) {
  StepOdds odds;
  EXPECT_FALSE(odds.stepped_most(1));
  odds.EndFrame(11);
  EXPECT_TRUE(odds.stepped_most(11));
  EXPECT_TRUE(odds.stepped_most(5));
  EXPECT_TRUE(odds.stepped_most(13));
  EXPECT_FALSE(odds.stepped_most(14));
  odds.EndFrame(0);
  EXPECT_FALSE(odds.stepped_most(1));
}

// A bridge whose step was undone once pays as much for the next one.
TEST(StepOdds, KnowForASecondThatThereWasAStep) {
  StepOdds odds;
  EXPECT_FALSE(odds.stepped_of_late());
  odds.EndFrame(11);
  for (int frame = 0; frame < 59; ++frame) odds.EndFrame(0);
  EXPECT_TRUE(odds.stepped_of_late());
  odds.EndFrame(0);
  EXPECT_FALSE(odds.stepped_of_late());
}

TEST(StepOdds, AreTriedAgainAfterHalfASecondWhateverTheRate) {
  for (const double rate : {30., 60., 120., 240., 1000.}) {
    StepOdds odds;
    int frames = 0;
    for (int trial = 0; trial < 12; ++trial) {
      odds.LearnGains(1, 1);
      for (frames = 0; !odds.wants_trial(); ++frames) odds.EndFrame(0, 0, 1 / rate);
    }
    EXPECT_EQ(frames, static_cast<int>(32 * std::max(1., rate / 60))) << rate << " Hz";
  }
}

TEST(StepOdds, AreTriedBeforeAnythingIsKnownAndSoonAgainWhereTheyDoNotPay) {
  StepOdds odds;
  EXPECT_TRUE(odds.pays());
  EXPECT_TRUE(odds.wants_trial());
  int last = 0;
  for (int trial = 0; trial < 6; ++trial) {
    odds.LearnGains(1, 1);
    EXPECT_FALSE(odds.pays());
    int frames = 0;
    for (; !odds.wants_trial(); ++frames) odds.EndFrame(0);
    EXPECT_GE(frames, last) << "ever later";
    EXPECT_LE(frames, 32);
    last = frames;
  }
  EXPECT_EQ(last, 32);
  for (int trial = 0; trial < 4; ++trial) odds.LearnGains(50, 1);
  ASSERT_TRUE(odds.pays());
  int frames = 0;
  for (; !odds.wants_trial(); ++frames) odds.EndFrame(1);
  EXPECT_EQ(frames, 16) << "where they pay, they cost more in vain";
}

TEST(StepOdds, PayWhereSweepsInTheirPlaceGainLess) {
  StepOdds odds;
  odds.LearnGains(2.9, 1);
  EXPECT_FALSE(odds.pays());
  odds.LearnGains(4, 1);
  EXPECT_TRUE(odds.pays()) << "3.4 on average";
  odds.LearnGains(1.5, 1);
  EXPECT_TRUE(odds.pays()) << "2.6: steps that come and go do harm";
  odds.LearnGains(1, 1);
  EXPECT_FALSE(odds.pays()) << "2.0";
}

TEST(StepOdds, PayEarlierInSmallStacks) {
  using Size = StepOdds::Size;
  StepOdds odds;
  odds.LearnGains(2.5, 1, Size::kFew);
  EXPECT_TRUE(odds.pays());
  odds.LearnGains(1.2, 1, Size::kFew);
  EXPECT_TRUE(odds.pays()) << "1.7 on average";
  odds.LearnGains(1, 1, Size::kFew);
  EXPECT_FALSE(odds.pays()) << "1.4";
}

TEST(StepOdds, PayEarlierStillInTinyStacksThatRock) {
  const auto pay = [](int frames, double error) {
    StepOdds odds;
    for (int frame = 0; frame < frames; ++frame) odds.EndFrame(0, error);
    odds.LearnGains(1.6, 1, StepOdds::Size::kFewest);
    return odds.pays();
  };
  EXPECT_TRUE(pay(30, 0.01));
  EXPECT_FALSE(pay(29, 0.01)) << "what hits something is done with it";
  EXPECT_FALSE(pay(60, 0.001)) << "it rests";
}

TEST(StepOdds, PayWhereSweepsAloneDoHarm) {
  StepOdds odds;
  odds.LearnGains(1, -1);
  EXPECT_TRUE(odds.pays());
  odds = {};
  odds.LearnGains(-1, -2);
  EXPECT_FALSE(odds.pays()) << "both do";
  odds = {};
  odds.LearnGains(0, 0);
  EXPECT_FALSE(odds.pays());
}

// A contact came in two frames, of all that there were.
TEST(StepOdds, OutliveDoubtsWhereStepsCarryMuch) {
  StepOdds odds;
  for (int trial = 0; trial < 10; ++trial) odds.LearnGains(50, 1);
  for (int doubt = 0; doubt < 3; ++doubt) {
    odds.LearnGains(-1, 1);
    EXPECT_TRUE(odds.pays()) << doubt;
  }
  for (int doubt = 0; doubt < 2; ++doubt) odds.LearnGains(-1, 1);
  EXPECT_FALSE(odds.pays());
}

// From 3 to 30 sweeps, by hand.
TEST(StepOdds, FindThePowerOfSweeps) {
  EXPECT_NEAR(StepOdds::PowerOf(3, 30, 0.01), 2, 1e-12);
  EXPECT_NEAR(StepOdds::PowerOf(3, 30, 10), -1, 1e-12);
  EXPECT_EQ(StepOdds::PowerOf(0, 10, 0.5), 0);
  EXPECT_EQ(StepOdds::PowerOf(10, 10, 0.5), 0);
  EXPECT_TRUE(std::isinf(StepOdds::PowerOf(3, 10, 0)));
  EXPECT_TRUE(std::isinf(StepOdds::PowerOf(3, 10, std::nan("")))) << "0 of 0";
}

/// Frames that kept a step, or did not.
void EndFrames(int frames, bool kept, StepOdds* odds) {
  for (int i = 0; i < frames; ++i) {
    odds->EndFrame(kept ? 1 : 0);
    odds->EndSteps(kept);
  }
}

TEST(StepOdds, EasesStepsAfterManyFramesOfSweepsAlone) {
  constexpr int kMany = StepOdds::kEased;
  StepOdds odds;
  EndFrames(kMany - 1, false, &odds);
  EXPECT_EQ(odds.share(), 1) << "it is young";
  EndFrames(1, true, &odds);
  EndFrames(kMany - 1, false, &odds);
  EXPECT_EQ(odds.share(), 1) << "a pause is no rest";
  EndFrames(1, false, &odds);
  EXPECT_TRUE(odds.only_looks());
  EXPECT_EQ(odds.share(), 1);
  odds.LearnGains(1, 0.1);
  EXPECT_FALSE(odds.only_looks());
  for (int i = 1; i <= kMany; ++i) {
    EXPECT_EQ(odds.share(), i / 8.0);
    EndFrames(1, true, &odds);
    EndFrames(2, false, &odds);
  }
  EXPECT_EQ(odds.share(), 1);
}

}  // namespace
}  // namespace cairn
