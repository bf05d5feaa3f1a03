// SPDX-License-Identifier: MIT
#include "simd/target.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/simd/environment.h"

namespace cairn::simd {
namespace {

using Reason = TargetChoice::Reason;

const std::vector<Target> kOldCpu = {Target::kScalar, Target::kSse4};

TEST(TargetTest, ScalarIsAlwaysSupportedAndTargetsAscend) {
  const std::vector<Target> targets = SupportedTargets();
  ASSERT_FALSE(targets.empty());
  EXPECT_EQ(targets.front(), Target::kScalar);
  EXPECT_EQ(targets.back(), BestTarget());
  for (std::size_t i = 1; i < targets.size(); ++i) EXPECT_LT(targets[i - 1], targets[i]);
}

TEST(TargetTest, EveryTargetIsFoundByItsName) {
  for (Target target :
       {Target::kScalar, Target::kSse4, Target::kAvx2, Target::kAvx512, Target::kNeon}) {
    EXPECT_EQ(FindTarget(TargetName(target)), target);
  }
  EXPECT_EQ(FindTarget("AVX2"), std::nullopt);
  EXPECT_EQ(FindTarget(""), std::nullopt);
}

TEST(TargetTest, WithoutAWishTheBestIsChosen) {
  const TargetChoice choice = ChooseTarget("", kOldCpu);
  EXPECT_EQ(choice.target, Target::kSse4);
  EXPECT_EQ(choice.reason, Reason::kBest);
  EXPECT_TRUE(choice.honoured());
}

TEST(TargetTest, ASupportedWishIsGranted) {
  const TargetChoice choice = ChooseTarget("scalar", kOldCpu);
  EXPECT_EQ(choice.target, Target::kScalar);
  EXPECT_EQ(choice.reason, Reason::kAsked);
  EXPECT_TRUE(choice.honoured());
}

TEST(TargetTest, WhatCannotBeGrantedIsSaidAndTheBestIsChosen) {
  const TargetChoice too_new = ChooseTarget("avx512", kOldCpu);
  EXPECT_EQ(too_new.target, Target::kSse4);
  EXPECT_EQ(too_new.reason, Reason::kUnsupported);
  EXPECT_EQ(too_new.asked, "avx512");
  EXPECT_FALSE(too_new.honoured());

  const TargetChoice typo = ChooseTarget("avx-2", kOldCpu);
  EXPECT_EQ(typo.target, Target::kSse4);
  EXPECT_EQ(typo.reason, Reason::kUnknown);
  EXPECT_EQ(typo.asked, "avx-2");
  EXPECT_FALSE(typo.honoured());
}

TEST(TargetTest, TheEnvironmentVariableIsRead) {
  test::SetVariable("CAIRN_SIMD", "scalar");
  EXPECT_EQ(ChooseTarget().target, Target::kScalar);
  EXPECT_EQ(ChosenTarget(), Target::kScalar);
  test::SetVariable("CAIRN_SIMD", "avx-2");
  EXPECT_EQ(ChosenTarget(), BestTarget());
  test::SetVariable("CAIRN_SIMD", "");
  EXPECT_EQ(ChooseTarget().target, BestTarget());
  EXPECT_EQ(ChosenTarget(), BestTarget());
  EXPECT_EQ(BestTarget(), SupportedTargets().back());
}

}  // namespace
}  // namespace cairn::simd
