// SPDX-License-Identifier: MIT
#include "support/progress.h"

#include <gtest/gtest.h>

namespace cairn::cli {
namespace {

TEST(TimeLeft, IsWhatTheRestTakesAtTheSamePace) {
  EXPECT_EQ(TimeLeft(10, 0.5), "10 s left");
  EXPECT_EQ(TimeLeft(10, 0.25), "30 s left");
  EXPECT_EQ(TimeLeft(60, 0.25), "3 min left");
  EXPECT_EQ(TimeLeft(60, 1), "0 s left");
}

TEST(TimeLeft, IsNotToldBeforeAFiftiethIsDone) {
  EXPECT_EQ(TimeLeft(10, 0), "");
  EXPECT_EQ(TimeLeft(10, 0.019), "");
  EXPECT_EQ(TimeLeft(10, 0.02), "8 min left");
}

}  // namespace
}  // namespace cairn::cli
