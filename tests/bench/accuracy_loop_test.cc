// SPDX-License-Identifier: MIT
// cairn_accuracy in closed loop: statistics over seeds, and runs that are stopped.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "accuracy/intervals.h"
#include "accuracy/loop/loop.h"
#include "accuracy/paired_test.h"
#include "cairn/contact_problem.h"
#include "run/scene_choice.h"

namespace cairn::accuracy {
namespace {

cli::SceneChoice Scene(const char* name, int size) {
  const std::vector<std::string> names = {name};
  return cli::ParseScenes(names, std::to_string(size), 0).front();
}

// P(Binomial(20, 1/2) <= 5) = 2.07 %, <= 6: 5.8 %. So from the 6th to the 15th of 20 values.
TEST(Intervals, OfTheMedianOf20ValuesReachesFromThe6thToThe15th) {
  std::vector<double> values(20);
  std::iota(values.rbegin(), values.rend(), 1);

  const Interval interval = MedianInterval(values);

  EXPECT_EQ(interval.value, 10);
  EXPECT_EQ(interval.low, 6);
  EXPECT_EQ(interval.high, 15);
}

// P(Binomial(6, 1/2) = 0) = 1.6 % and P(Binomial(8, 1/2) <= 1) = 3.5 %, which is too much.
TEST(Intervals, OfFewValuesReachFromTheSmallestToTheLargest) {
  for (const int count : {2, 5, 6, 8}) {
    std::vector<double> values(count);
    std::iota(values.begin(), values.end(), 1);
    EXPECT_EQ(MedianInterval(values).low, 1) << count;
    EXPECT_EQ(MedianInterval(values).high, count) << count;
  }
  EXPECT_TRUE(std::isnan(MedianInterval({}).value));
}

// Wilson's interval of 0 of 20: [0, z^2 / (n + z^2)]; of 10 of 20 it is 1/2 -+ 0.2007.
TEST(Intervals, OfSharesAreThoseOfWilson) {
  EXPECT_EQ(ShareInterval(0, 20).low, 0);
  EXPECT_NEAR(ShareInterval(0, 20).high, 3.8415 / 23.8415, 1e-4);
  EXPECT_NEAR(ShareInterval(10, 20).low, 0.5 - 0.2007, 1e-4);
  EXPECT_NEAR(ShareInterval(20, 20).low, 1 - 3.8415 / 23.8415, 1e-4);
}

// All 2^n signs are as likely: five of one sign, 2 of 32; the smallest of six of the other sign, 4
// of 64; three alike, everything goes.
TEST(PairedTest, IsExactForFewPairs) {
  const std::vector<double> zeros(6);
  const std::vector<double> five = {1, 2, 3, 4, 5}, six = {-1, 2, 3, 4, 5, 6}, alike = {1, -1, 1};
  EXPECT_DOUBLE_EQ(ComparePaired(five, std::span(zeros).first(5)).p, 2.0 / 32);
  EXPECT_DOUBLE_EQ(ComparePaired(six, zeros).p, 4.0 / 64);
  EXPECT_DOUBLE_EQ(ComparePaired(alike, std::span(zeros).first(3)).p, 1);
  EXPECT_DOUBLE_EQ(ComparePaired({}, {}).p, 1);
}

// Table of Wilcoxon's T: for 20 pairs 52 is the largest that is significant at 5 %.
TEST(PairedTest, HasTheCriticalValueOfTheTables) {
  const auto p_of = [](int sum) {
    std::vector<double> values(20), zeros(20);
    std::iota(values.begin(), values.end(), 1);
    for (int rank = 20; rank > 0; --rank) {
      if (rank > sum) continue;
      values[rank - 1] *= -1;
      sum -= rank;
    }
    return ComparePaired(values, zeros).p;
  };
  EXPECT_LE(p_of(52), 0.05);
  EXPECT_GT(p_of(53), 0.05);
}

TEST(PairedTest, CountsFailedRunsAsWorstAndLeavesNanOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> first = {1, kInfinity, 3, nan, kInfinity},
                            second = {2, kInfinity, kInfinity, 1, 5};
  const PairedTest test = ComparePaired(first, second);
  EXPECT_EQ(test.less, 2);
  EXPECT_EQ(test.more, 1);
  EXPECT_EQ(test.equal, 1);
  EXPECT_DOUBLE_EQ(test.p, 1);  // ranks 1, 2.5 against 2.5
}

TEST(HolmAdjusted, MultipliesByWhatIsLeftAndNeverFalls) {
  const std::vector<double> adjusted = HolmAdjusted(std::vector<double>{0.01, 0.04, 0.03});
  EXPECT_DOUBLE_EQ(adjusted[0], 0.03);
  EXPECT_DOUBLE_EQ(adjusted[1], 0.06);
  EXPECT_DOUBLE_EQ(adjusted[2], 0.06);
  EXPECT_EQ(HolmAdjusted(std::vector<double>{0.9, 0.8})[0], 1);
}

TEST(Loop, StopsAfterARunAndKeepsWhatIsDone) {
  const LoopOptions options{.scenes = {Scene("heavy-top", 3), Scene("tower", 3)},
                            .frames = 4,
                            .seeds = 3,
                            .budgets = {std::chrono::milliseconds(1)}};
  int runs = 0;
  const auto loops = [&](int most) {
    runs = 0;
    return RunLoops(
        options, [](const std::string&) {}, [&] { return ++runs == most; });
  };
  const std::vector<LoopScene> three = loops(3);
  ASSERT_EQ(three.size(), 2u);
  EXPECT_EQ(three[0].seeds(), 2);
  EXPECT_EQ(three[1].seeds(), 1);
  EXPECT_EQ(three[0].Of(0, Kind::kSteps).solver, "steps");
  EXPECT_EQ(three[0].bullet().solver, "bullet-si");
  EXPECT_EQ(loops(1).size(), 1u);
  EXPECT_EQ(loops(100)[1].seeds(), 3);
  EXPECT_EQ(runs, 6);
}

}  // namespace
}  // namespace cairn::accuracy
