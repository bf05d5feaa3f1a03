// SPDX-License-Identifier: MIT
#include "cairn/bullet/constraint_solver_pool.h"

#include <mutex>
#include <utility>
#include <vector>

#include "group/group_order.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {

struct ConstraintSolverPool::Impl {
  Impl(const Settings& settings, const Options& options) : solver(settings, options) {}

  /// Appends what came, for all at a time.
  template <class Thing>
  static void Append(Thing** things, int count, std::vector<Thing*>* all) {
    all->insert(all->end(), things, things + count);
  }

  ConstraintSolver solver;
  std::mutex mutex;
  bool collecting = false;
  std::vector<btCollisionObject*> bodies;
  std::vector<btPersistentManifold*> manifolds;
  std::vector<btTypedConstraint*> joints;
  btDispatcher* dispatcher = nullptr;
  GroupOrder order;

  void ForgetGroups() {
    bodies.clear();
    manifolds.clear();
    joints.clear();
    dispatcher = nullptr;
  }
};

ConstraintSolverPool::ConstraintSolverPool(const Settings& settings, const Options& options)
    : btConstraintSolverPoolMt(nullptr, 0), impl_(std::make_unique<Impl>(settings, options)) {}

ConstraintSolverPool::~ConstraintSolverPool() = default;

ConstraintSolver& ConstraintSolverPool::solver() { return impl_->solver; }

void ConstraintSolverPool::prepareSolve(int, int) {
  const std::lock_guard lock(impl_->mutex);
  impl_->collecting = true;
  impl_->ForgetGroups();
}

btScalar ConstraintSolverPool::solveGroup(btCollisionObject** bodies, int num_bodies,
                                          btPersistentManifold** manifolds, int num_manifolds,
                                          btTypedConstraint** constraints, int num_constraints,
                                          const btContactSolverInfo& info,
                                          btIDebugDraw* debug_drawer, btDispatcher* dispatcher) {
  const std::lock_guard lock(impl_->mutex);
  if (!impl_->collecting) {
    return impl_->solver.solveGroup(bodies, num_bodies, manifolds, num_manifolds, constraints,
                                    num_constraints, info, debug_drawer, dispatcher);
  }
  Impl::Append(bodies, num_bodies, &impl_->bodies);
  Impl::Append(manifolds, num_manifolds, &impl_->manifolds);
  Impl::Append(constraints, num_constraints, &impl_->joints);
  impl_->dispatcher = dispatcher;
  return 0;
}

void ConstraintSolverPool::allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_drawer) {
  const std::lock_guard lock(impl_->mutex);
  if (!std::exchange(impl_->collecting, false)) return;
  impl_->order.SortBodies(&impl_->bodies);
  impl_->order.SortManifolds(&impl_->manifolds);
  impl_->order.SortJoints(&impl_->joints);
  const auto size = [](const auto& list) { return static_cast<int>(list.size()); };
  impl_->solver.prepareSolve(size(impl_->bodies), size(impl_->manifolds));
  impl_->solver.solveGroup(impl_->bodies.data(), size(impl_->bodies), impl_->manifolds.data(),
                           size(impl_->manifolds), impl_->joints.data(), size(impl_->joints), info,
                           debug_drawer, impl_->dispatcher);
  impl_->solver.allSolved(info, debug_drawer);
  impl_->ForgetGroups();
}

void ConstraintSolverPool::reset() {
  const std::lock_guard lock(impl_->mutex);
  impl_->solver.reset();
}

btConstraintSolverType ConstraintSolverPool::getSolverType() const {
  return impl_->solver.getSolverType();
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
