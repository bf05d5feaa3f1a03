// SPDX-License-Identifier: MIT
#pragma once

#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <Eigen/Core>
#include <limits>
#include <type_traits>

namespace cairn::bench {

/// What Bullet's iteration needs to know of a body that can move, or cannot.
struct PoolBody {
  bool moves = false;
  Eigen::Vector3d inv_mass = Eigen::Vector3d::Zero();  ///< Along each axis.
};

/// A row as Bullet's solvers keep it; unused vectors stay zero.
struct PoolRow {
  enum class Pool { kJoint, kContact, kFriction, kTwist };

  Pool pool = Pool::kJoint;
  int body_a = 0, body_b = 0;
  Eigen::Vector3d linear_a = Eigen::Vector3d::Zero(), angular_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d linear_b = Eigen::Vector3d::Zero(), angular_b = Eigen::Vector3d::Zero();
  /// Inverse inertia times the above.
  Eigen::Vector3d response_a = Eigen::Vector3d::Zero(), response_b = Eigen::Vector3d::Zero();
  double step = 0;  ///< Impulse for a unit of velocity.
  double target = 0, compliance = 0;
  double lo = 0, hi = 0;
  double friction = 0;
  int contact = 0;  ///< Of friction and twists: the number of its row in the pool of contacts.
  double impulse = 0;
};

/// Rows in the memory of one of Bullet's own solvers, put there by hand, and swept over by its own
/// compiled code. `Base` is btSequentialImpulseConstraintSolver or btNNCGConstraintSolver.
template <class Base>
class BulletPools : protected Base {
 public:
  BulletPools() { info_.m_numIterations = std::numeric_limits<int>::max(); }

  void Clear() {
    bodies().resizeNoInitialize(0);
    for (const auto pool : {PoolRow::Pool::kJoint, PoolRow::Pool::kContact,
                            PoolRow::Pool::kFriction, PoolRow::Pool::kTwist}) {
      rows(pool).resizeNoInitialize(0);
    }
  }

  /// @return its number
  int AddBody(const PoolBody& body) {
    const btVector3 zero(0, 0, 0), one(1, 1, 1);
    btSolverBody& to = bodies().expandNonInitializing();
    to.m_worldTransform.setIdentity();
    to.m_linearFactor = to.m_angularFactor = one;
    to.m_invMass = Convert(body.inv_mass);
    to.m_deltaLinearVelocity = to.m_deltaAngularVelocity = zero;
    to.m_pushVelocity = to.m_turnVelocity = zero;
    to.m_linearVelocity = to.m_angularVelocity = zero;
    to.m_externalForceImpulse = to.m_externalTorqueImpulse = zero;
    // a row moves only bodies that have one, and asks no more of it
    to.m_originalBody = body.moves ? &movable_ : nullptr;
    return bodies().size() - 1;
  }

  /// @return its number in its pool
  int AddRow(const PoolRow& row) {
    btSolverConstraint& to = rows(row.pool).expandNonInitializing();
    to.m_contactNormal1 = Convert(row.linear_a);
    to.m_relpos1CrossNormal = Convert(row.angular_a);
    to.m_contactNormal2 = Convert(row.linear_b);
    to.m_relpos2CrossNormal = Convert(row.angular_b);
    to.m_angularComponentA = Convert(row.response_a);
    to.m_angularComponentB = Convert(row.response_b);
    to.m_appliedPushImpulse = 0;
    to.m_appliedImpulse = static_cast<btScalar>(row.impulse);
    to.m_friction = static_cast<btScalar>(row.friction);
    to.m_jacDiagABInv = static_cast<btScalar>(row.step);
    to.m_rhs = static_cast<btScalar>(row.target * row.step);
    to.m_cfm = static_cast<btScalar>(row.compliance * row.step);
    to.m_rhsPenetration = 0;
    to.m_lowerLimit = Bound(row.lo);
    to.m_upperLimit = Bound(row.hi);
    to.m_originalContactPoint = nullptr;
    to.m_overrideNumSolverIterations = std::numeric_limits<int>::max();
    to.m_frictionIndex = row.contact;
    to.m_solverBodyIdA = row.body_a;
    to.m_solverBodyIdB = row.body_b;
    return rows(row.pool).size() - 1;
  }

  /// After the last row, and before the first sweep: rows are swept in the order they came in.
  void Begin() {
    CountUp(this->m_tmpSolverContactConstraintPool.size(), &this->m_orderTmpConstraintPool);
    CountUp(this->m_tmpSolverContactFrictionConstraintPool.size(),
            &this->m_orderFrictionConstraintPool);
    CountUp(this->m_tmpSolverNonContactConstraintPool.size(),
            &this->m_orderNonContactConstraintPool);
    if constexpr (std::is_same_v<Base, btNNCGConstraintSolver>) MakeRoom();
    sweeps_ = 0;
  }

  /// Bullet's iteration: joints, all contacts, all friction.
  void Sweep() {
    this->solveSingleIteration(sweeps_++, nullptr, 0, nullptr, 0, nullptr, 0, info_, nullptr);
  }

  btAlignedObjectArray<btSolverBody>& bodies() { return this->m_tmpSolverBodyPool; }
  const btAlignedObjectArray<btSolverBody>& bodies() const { return this->m_tmpSolverBodyPool; }
  btConstraintArray& rows(PoolRow::Pool pool) {
    switch (pool) {
      case PoolRow::Pool::kContact:
        return this->m_tmpSolverContactConstraintPool;
      case PoolRow::Pool::kFriction:
        return this->m_tmpSolverContactFrictionConstraintPool;
      case PoolRow::Pool::kTwist:
        return this->m_tmpSolverContactRollingFrictionConstraintPool;
      case PoolRow::Pool::kJoint:
        break;
    }
    return this->m_tmpSolverNonContactConstraintPool;
  }
  const btConstraintArray& rows(PoolRow::Pool pool) const {
    return const_cast<BulletPools*>(this)->rows(pool);
  }

 private:
  static btVector3 Convert(const Eigen::Vector3d& v) {
    return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()),
            static_cast<btScalar>(v.z())};
  }
  static btScalar Bound(double bound) {
    constexpr double kMost = SIMD_INFINITY;
    return static_cast<btScalar>(bound > kMost ? kMost : bound < -kMost ? -kMost : bound);
  }
  static void CountUp(int size, btAlignedObjectArray<int>* order) {
    order->resizeNoInitialize(size);
    for (int i = 0; i < size; ++i) (*order)[i] = i;
  }
  /// What its set-up does.
  void MakeRoom() {
    const auto resize = [this](PoolRow::Pool pool, auto* a, auto* b) {
      a->resizeNoInitialize(rows(pool).size());
      b->resizeNoInitialize(rows(pool).size());
    };
    resize(PoolRow::Pool::kJoint, &this->m_pNC, &this->m_deltafNC);
    resize(PoolRow::Pool::kContact, &this->m_pC, &this->m_deltafC);
    resize(PoolRow::Pool::kFriction, &this->m_pCF, &this->m_deltafCF);
    resize(PoolRow::Pool::kTwist, &this->m_pCRF, &this->m_deltafCRF);
  }

  btContactSolverInfo info_;
  int sweeps_ = 0;
  btRigidBody movable_{1, nullptr, nullptr};  ///< Stands for all bodies that can move.
};

}  // namespace cairn::bench
