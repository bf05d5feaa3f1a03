// SPDX-License-Identifier: MIT
#include "bullet_adapter/src/contacts/twist_memory.h"

#include <gtest/gtest.h>

namespace cairn::test {
namespace {

using Impulses = bullet::TwistMemory::Impulses;

/// Two points with one and with two rows.
class TwistMemory : public testing::Test {
 protected:
  TwistMemory() {
    points_[0].m_appliedImpulse = 3;
    points_[1].m_appliedImpulse = 4;
    group_.impulses = {3, btScalar(0.5), 4, btScalar(-0.25), btScalar(0.75)};
    group_.points = {{&points_[0], 0, kNoRow, 1, 0, 1, {}}, {&points_[1], 2, kNoRow, 3, 0, 2, {}}};
    memory_.Keep(group_);
    memory_.Begin();
  }

  btManifoldPoint points_[2];
  bullet::GroupProblem group_;
  bullet::TwistMemory memory_;
};

TEST_F(TwistMemory, FindsPointsInAnyOrder) {
  EXPECT_EQ(memory_.Find(points_[1]), (Impulses{btScalar(-0.25), btScalar(0.75), 0}));
  EXPECT_EQ(memory_.Find(points_[0]), (Impulses{btScalar(0.5), 0, 0}));
}

TEST_F(TwistMemory, DoesNotTakeAPointForAnotherOneAtItsAddress) {
  points_[0].m_appliedImpulse = 0;  // what points begin with
  EXPECT_EQ(memory_.Find(points_[0]), Impulses{});
  EXPECT_EQ(memory_.Find(btManifoldPoint{}), Impulses{});
}

TEST_F(TwistMemory, ForgetsWhatItIsToldToForget) {
  memory_.Forget();
  EXPECT_EQ(memory_.Find(points_[0]), Impulses{});
}

}  // namespace
}  // namespace cairn::test
