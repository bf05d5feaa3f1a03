// SPDX-License-Identifier: MIT
// Which engine solves, and what turns steps off.
#include <gtest/gtest.h>

#include "cairn/settings.h"
#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using test::Scene;

TEST(Path, OfTheDefaultsIsFast) {
  EXPECT_EQ(PathOf(Settings{}), Path::kFast);
  EXPECT_EQ(PathOf({.tolerance = 0}), Path::kFast);
  EXPECT_EQ(PathOf({.tolerance = 1e-5}), Path::kFast);
}

TEST(Path, OfAToleranceTooFineForFloatsIsTheReference) {
  EXPECT_EQ(PathOf({.tolerance = 0.99e-5}), Path::kReference);
  EXPECT_EQ(PathOf({.path = Path::kFast, .tolerance = 1e-9}), Path::kFast);
  EXPECT_EQ(PathOf({.path = Path::kReference}), Path::kReference);
}

TEST(Path, IsReported) {
  const Scene scene = test::Wall(4, 4);
  for (const Path path : {Path::kFast, Path::kReference}) {
    EXPECT_EQ(test::Solve({.path = path}, scene).report.path, path);
  }
  EXPECT_EQ(test::Solve({.tolerance = 1e-9}, scene).report.path, Path::kReference);
  EXPECT_EQ(test::Solve({.threads = 0}, scene).report.path, Path::kAuto);  // refused
}

// 1e13 N s to start from are none that blocks take.
TEST(Path, IsTheReferenceWhereFloatsCannotHoldTheStart) {
  const Scene scene = test::Wall(2, 2);
  std::vector<double> start(scene.rows.size(), 0);
  start[0] = 1e13;
  EXPECT_EQ(test::Solve({.path = Path::kFast}, scene, start).report.path, Path::kReference);
}

TEST(Steps, OffAreNoneAndTheSameAsNoFactorisations) {
  const Scene scene = test::Wall(6, 6);
  const Settings always{.max_sweeps = 40, .tolerance = 0, .step_policy = StepPolicy::kAlways};
  EXPECT_GT(test::Solve(always, scene).report.factorisations, 0);
  Settings off = always, none = always;
  off.steps = false;
  none.k_sm = 0;
  const auto without = test::Solve(off, scene);
  EXPECT_EQ(without.report.factorisations, 0);
  EXPECT_TRUE(test::SameBits(without, test::Solve(none, scene)));
}

}  // namespace
}  // namespace cairn
