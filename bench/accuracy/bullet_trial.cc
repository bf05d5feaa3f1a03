// SPDX-License-Identifier: MIT
#include "accuracy/bullet_trial.h"

#include <utility>

#include "cairn/bullet/group_rows.h"
#include "cli/solver_clock.h"
#include "measure/row_recorder.h"

namespace cairn::accuracy {
namespace {

/// Adds the CPU time of its life to a sum [ms].
class Stopwatch {
 public:
  explicit Stopwatch(double* sum) : sum_(sum) {}
  ~Stopwatch() { *sum_ += cli::Now(cli::SolverClock::kThreadCpu) - start_; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double* sum_;
  double start_ = cli::Now(cli::SolverClock::kThreadCpu);
};

}  // namespace

class BulletTrial::Solver : public bench::RowRecorder {
 public:
  void Follow(Follower follower) { follower_ = std::move(follower); }
  BulletTime TakeTime() { return std::exchange(time_, {}); }

 protected:
  btScalar solveGroupCacheFriendlySetup(btCollisionObject** bodies, int num_bodies,
                                        btPersistentManifold** manifolds, int num_manifolds,
                                        btTypedConstraint** constraints, int num_constraints,
                                        const btContactSolverInfo& info,
                                        btIDebugDraw* debug_drawer) override {
    const Stopwatch stopwatch(&time_.set_up);
    return RowRecorder::solveGroupCacheFriendlySetup(bodies, num_bodies, manifolds, num_manifolds,
                                                     constraints, num_constraints, info,
                                                     debug_drawer);
  }

  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int num_bodies,
                                             btPersistentManifold** manifolds, int num_manifolds,
                                             btTypedConstraint** constraints, int num_constraints,
                                             const btContactSolverInfo& info,
                                             btIDebugDraw* debug_drawer) override {
    if (follower_) {
      rows_.Read(pools_, info, bullet::SweepLimits::kNone);
      rows_.ReadVelocities(pools_);
      if (!follower_(0, rows_.velocities())) return 0;
    }
    {
      const Stopwatch stopwatch(&time_.iterations);
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
    const Stopwatch stopwatch(&time_.split);
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
    const Stopwatch stopwatch(&time_.finish);
    return RowRecorder::solveGroupCacheFriendlyFinish(bodies, num_bodies, info);
  }

 private:
  const bullet::RowPools pools_{
      &m_tmpSolverBodyPool, &m_tmpSolverNonContactConstraintPool, &m_tmpSolverContactConstraintPool,
      &m_tmpSolverContactFrictionConstraintPool, &m_tmpSolverContactRollingFrictionConstraintPool};
  Follower follower_;
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

bench::ContactFrame BulletTrial::Rows(const bench::Substep& substep,
                                      const btContactSolverInfo& info) {
  bench::ContactFrame frame;
  solver_->RecordTo(&frame);
  Solve(substep, info, 1);
  solver_->RecordTo(nullptr);
  return frame;
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
