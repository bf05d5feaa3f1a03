// SPDX-License-Identifier: MIT
#include "accuracy/bullet_trial.h"

#include <utility>

#include "cairn/bullet/detail/group_rows.h"
#include "cairn/detail/eigen.h"
#include "measure/row_recorder.h"
#include "support/machine/stopwatch.h"

namespace cairn::accuracy {
namespace {

constexpr cli::SolverClock kClock = cli::SolverClock::kThreadCpu;

bool Moves(const Body& body) { return body.inv_mass > 0 || !View(body.inv_inertia).isZero(0); }

}  // namespace

std::vector<Velocity> RecordedSubstep::Changes() const {
  std::vector<Velocity> changes(starts.size());
  for (size_t i = 0; i < starts.size(); ++i) {
    const Start& start = starts[i];
    if (start.body == nullptr) continue;
    const Velocity now{.linear = start.body->getLinearVelocity(),
                       .angular = start.body->getAngularVelocity()};
    changes[i] = {.linear = View(now.linear) - View(start.velocity.linear),
                  .angular = View(now.angular) - View(start.velocity.angular)};
  }
  return changes;
}

class BulletTrial::Solver : public bench::RowRecorder {
 public:
  void Follow(Follower follower) { follower_ = std::move(follower); }
  /// Records the next group, once.
  void Record(RecordedSubstep* to) {
    recorded_ = to;
    RecordTo(to != nullptr ? &to->frame : nullptr);
  }
  BulletTime TakeTime() { return std::exchange(time_, {}); }

 protected:
  btScalar solveGroupCacheFriendlySetup(btCollisionObject** bodies, int num_bodies,
                                        btPersistentManifold** manifolds, int num_manifolds,
                                        btTypedConstraint** constraints, int num_constraints,
                                        const btContactSolverInfo& info,
                                        btIDebugDraw* debug_drawer) override {
    const cli::SummedTime summed(kClock, &time_.set_up);
    return RowRecorder::solveGroupCacheFriendlySetup(bodies, num_bodies, manifolds, num_manifolds,
                                                     constraints, num_constraints, info,
                                                     debug_drawer);
  }

  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int num_bodies,
                                             btPersistentManifold** manifolds, int num_manifolds,
                                             btTypedConstraint** constraints, int num_constraints,
                                             const btContactSolverInfo& info,
                                             btIDebugDraw* debug_drawer) override {
    if (recorded_ != nullptr) ReadStarts();
    if (follower_) {
      rows_.Read(pools_, info, bullet::SweepLimits::kNone);
      rows_.ReadVelocities(pools_);
      if (!follower_(0, rows_.velocities())) return 0;
    }
    {
      const cli::SummedTime summed(kClock, &time_.iterations);
      RowRecorder::solveGroupCacheFriendlyIterations(bodies, num_bodies, manifolds, num_manifolds,
                                                     constraints, num_constraints, info,
                                                     debug_drawer);
    }
    time_.iterations -= time_.split;  // is inside
    return 0;
  }

  void solveGroupCacheFriendlySplitImpulseIterations(
      btCollisionObject** bodies, int num_bodies, btPersistentManifold** manifolds,
      int num_manifolds, btTypedConstraint** constraints, int num_constraints,
      const btContactSolverInfo& info, btIDebugDraw* debug_drawer) override {
    if (follower_) return;
    const cli::SummedTime summed(kClock, &time_.split);
    RowRecorder::solveGroupCacheFriendlySplitImpulseIterations(bodies, num_bodies, manifolds,
                                                               num_manifolds, constraints,
                                                               num_constraints, info, debug_drawer);
  }

  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int num_bodies,
                                btPersistentManifold** manifolds, int num_manifolds,
                                btTypedConstraint** constraints, int num_constraints,
                                const btContactSolverInfo& info,
                                btIDebugDraw* debug_drawer) override {
    const btScalar residual =
        RowRecorder::solveSingleIteration(iteration, bodies, num_bodies, manifolds, num_manifolds,
                                          constraints, num_constraints, info, debug_drawer);
    if (!follower_) return residual;
    rows_.ReadVelocities(pools_);
    constexpr btScalar kGoOn = 1, kStop = 0;  // against a threshold of 0
    return follower_(iteration + 1, rows_.velocities()) ? kGoOn : kStop;
  }

  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int num_bodies,
                                         const btContactSolverInfo& info) override {
    const cli::SummedTime summed(kClock, &time_.finish);
    return RowRecorder::solveGroupCacheFriendlyFinish(bodies, num_bodies, info);
  }

 private:
  void ReadStarts() {
    for (int i = 0; i < m_tmpSolverBodyPool.size(); ++i) {
      const btSolverBody& body = m_tmpSolverBodyPool[i];
      recorded_->starts.push_back(
          {body.m_originalBody,
           {.linear = body.m_linearVelocity + body.m_externalForceImpulse,
            .angular = body.m_angularVelocity + body.m_externalTorqueImpulse}});
    }
    recorded_ = nullptr;
  }

  const bullet::RowPools pools_{
      &m_tmpSolverBodyPool, &m_tmpSolverNonContactConstraintPool, &m_tmpSolverContactConstraintPool,
      &m_tmpSolverContactFrictionConstraintPool, &m_tmpSolverContactRollingFrictionConstraintPool};
  Follower follower_;
  RecordedSubstep* recorded_ = nullptr;
  bullet::GroupRows rows_;
  BulletTime time_;
};

BulletTrial::BulletTrial() : solver_(std::make_unique<Solver>()) {}
BulletTrial::~BulletTrial() = default;

BulletTime BulletTrial::Solve(const bench::Substep& substep, const btContactSolverInfo& info,
                              int iterations) {
  btContactSolverInfo own = info;
  own.m_numIterations = iterations;
  substep.Restore();
  substep.SolveWith(solver_.get(), own, nullptr);
  return solver_->TakeTime();
}

RecordedSubstep BulletTrial::Record(const bench::Substep& substep,
                                    const btContactSolverInfo& info) {
  RecordedSubstep recorded;
  solver_->Record(&recorded);
  Solve(substep, info, 1);
  solver_->Record(nullptr);
  for (size_t i = 0; i < recorded.starts.size(); ++i) {
    if (!Moves(recorded.frame.bodies[i])) recorded.starts[i].body = nullptr;
  }
  return recorded;
}

void BulletTrial::Follow(const bench::Substep& substep, const btContactSolverInfo& info, int most,
                         Follower follower) {
  btContactSolverInfo own = info;
  own.m_leastSquaresResidualThreshold = 0;
  solver_->Follow(std::move(follower));
  Solve(substep, own, most);
  solver_->Follow(nullptr);
}

}  // namespace cairn::accuracy
