// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <functional>
#include <utility>

#include "cairn/bullet/detail/group_rows.h"

namespace cairn::bench {

/// Any Bullet solver derived from btSequentialImpulseConstraintSolver, with its answer read out of
/// the row pools just before it is written back: the same rows, impulses and velocity changes,
/// whatever made them.
template <class Base>
class Observed : public Base {
 public:
  using Base::Base;
  using Observer = std::function<void(bullet::GroupRows&)>;

  /// Called once per solved group; none stops observing.
  void Observe(Observer observer) { observer_ = std::move(observer); }
  /// Time spent observing since the last call, to be taken off measured times.
  std::chrono::nanoseconds TakeObservingTime() { return std::exchange(observing_, {}); }

 protected:
  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int num_bodies,
                                         const btContactSolverInfo& info) override {
    if (observer_) {
      const auto start = std::chrono::steady_clock::now();
      const bullet::RowPools pools{
          &this->m_tmpSolverBodyPool, &this->m_tmpSolverNonContactConstraintPool,
          &this->m_tmpSolverContactConstraintPool, &this->m_tmpSolverContactFrictionConstraintPool,
          &this->m_tmpSolverContactRollingFrictionConstraintPool};
      rows_.Read(pools, info, bullet::SweepLimits::kNone);
      rows_.ReadVelocities(pools);
      observer_(rows_);
      observing_ += std::chrono::steady_clock::now() - start;
    }
    return Base::solveGroupCacheFriendlyFinish(bodies, num_bodies, info);
  }

 private:
  Observer observer_;
  bullet::GroupRows rows_;
  std::chrono::nanoseconds observing_{0};
};

}  // namespace cairn::bench
