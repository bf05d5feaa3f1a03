// SPDX-License-Identifier: MIT
#include "micro/bullet_rows.h"

#include <cfloat>
#include <climits>
#include <numeric>

#include "micro/sound.h"

namespace cairn::micro {
namespace {

using simd::RowBound;

btVector3 Convert(const Eigen::Vector3d& v) {
  return btVector3(static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()));
}

btVector3 AngularComponent(const SceneBody& body, const Eigen::Vector3d& angular) {
  return Convert(body.root * (body.root.transpose() * angular));
}

void CountUp(int size, btAlignedObjectArray<int>* order) {
  order->resizeNoInitialize(size);
  if (size > 0) std::iota(&(*order)[0], &(*order)[0] + size, 0);
}

void ClearImpulses(btConstraintArray* rows) {
  for (int i = 0; i < rows->size(); ++i) (*rows)[i].m_appliedImpulse = 0;
}

void AppendImpulses(const btConstraintArray& rows, int begin, int end, std::vector<float>* to) {
  for (int i = begin; i < end; ++i) to->push_back(rows[i].m_appliedImpulse);
}

}  // namespace

BulletRows::BulletRows(const RowScene& scene) {
  for (const SceneBody& body : scene.bodies) AddBody(body);
  for (const RowScene::Pair& pair : scene.pairs) {
    pairs_.push_back(NextRows());
    const int count = static_cast<int>(scene.layouts[pair.layout].size());
    for (int i = 0; i < count; ++i) AddRow(scene, pair, i);
  }
  pairs_.push_back(NextRows());
  CountUp(m_tmpSolverContactConstraintPool.size(), &m_orderTmpConstraintPool);
  CountUp(m_tmpSolverContactFrictionConstraintPool.size(), &m_orderFrictionConstraintPool);
  CountUp(m_tmpSolverNonContactConstraintPool.size(), &m_orderNonContactConstraintPool);
}

BulletRows::PairRows BulletRows::NextRows() const {
  return {m_tmpSolverContactConstraintPool.size(), m_tmpSolverContactFrictionConstraintPool.size(),
          m_tmpSolverNonContactConstraintPool.size()};
}

void BulletRows::AddBody(const SceneBody& body) {
  const btVector3 zero(0, 0, 0), one(1, 1, 1);
  btSolverBody& solver_body = m_tmpSolverBodyPool.expandNonInitializing();
  solver_body.m_worldTransform.setIdentity();
  solver_body.m_worldTransform.setOrigin(Convert(body.position));
  solver_body.m_deltaLinearVelocity = solver_body.m_deltaAngularVelocity = zero;
  solver_body.m_linearFactor = solver_body.m_angularFactor = one;
  solver_body.m_invMass = one * static_cast<float>(body.inv_mass);
  solver_body.m_pushVelocity = solver_body.m_turnVelocity = zero;
  solver_body.m_linearVelocity = Convert(body.velocity);
  solver_body.m_angularVelocity = Convert(body.spin);
  solver_body.m_externalForceImpulse = solver_body.m_externalTorqueImpulse = zero;
  // a row moves only bodies that have one, and asks no more of it
  solver_body.m_originalBody = body.inv_mass > 0 ? &movable_ : nullptr;
}

void BulletRows::AddRow(const RowScene& scene, const RowScene::Pair& pair, int index) {
  const SceneRow& row = scene.rows[pair.first_row + index];
  const simd::RowShape& shape = scene.layouts[pair.layout][index];
  const bool is_contact = shape.bound == RowBound::kPush;
  const bool is_friction = shape.bound == RowBound::kFriction;
  btSolverConstraint& to = (is_contact    ? m_tmpSolverContactConstraintPool
                            : is_friction ? m_tmpSolverContactFrictionConstraintPool
                                          : m_tmpSolverNonContactConstraintPool)
                               .expandNonInitializing();
  to.m_contactNormal1 = Convert(row.linear);
  to.m_relpos1CrossNormal = Convert(row.angular_a);
  to.m_contactNormal2 = pair.b == 0 ? btVector3(0, 0, 0) : -Convert(row.linear);
  to.m_relpos2CrossNormal = Convert(row.angular_b);
  to.m_angularComponentA = AngularComponent(scene.bodies[pair.a], row.angular_a);
  to.m_angularComponentB = AngularComponent(scene.bodies[pair.b], row.angular_b);
  to.m_appliedPushImpulse = to.m_appliedImpulse = 0;
  to.m_friction = is_friction ? static_cast<float>(row.limit) : 0;
  to.m_jacDiagABInv = static_cast<float>(row.step);
  to.m_rhs = static_cast<float>(row.target * row.step);
  to.m_cfm = to.m_rhsPenetration = 0;
  const float limit = shape.bound == RowBound::kFree ? FLT_MAX : static_cast<float>(row.limit);
  to.m_lowerLimit = is_contact ? 0 : -limit;
  to.m_upperLimit = is_contact ? 1e10f : limit;
  to.m_originalContactPoint = nullptr;
  to.m_overrideNumSolverIterations = INT_MAX;
  to.m_frictionIndex = is_friction ? pairs_.back().contacts + shape.parent : 0;
  to.m_solverBodyIdA = pair.a;
  to.m_solverBodyIdB = pair.b;
}

void BulletRows::Reset() {
  ClearImpulses(&m_tmpSolverContactConstraintPool);
  ClearImpulses(&m_tmpSolverContactFrictionConstraintPool);
  ClearImpulses(&m_tmpSolverNonContactConstraintPool);
  for (int i = 0; i < m_tmpSolverBodyPool.size(); ++i) {
    m_tmpSolverBodyPool[i].m_deltaLinearVelocity.setZero();
    m_tmpSolverBodyPool[i].m_deltaAngularVelocity.setZero();
  }
}

void BulletRows::Sweep() {
  solveSingleIteration(0, nullptr, 0, nullptr, 0, nullptr, 0, info_, nullptr);
}

void BulletRows::SolveFriction(btSolverConstraint* row) {
  const float normal = m_tmpSolverContactConstraintPool[row->m_frictionIndex].m_appliedImpulse;
  if (!(normal > 0)) return;
  row->m_lowerLimit = -(row->m_friction * normal);
  row->m_upperLimit = row->m_friction * normal;
  m_resolveSingleConstraintRowGeneric(m_tmpSolverBodyPool[row->m_solverBodyIdA],
                                      m_tmpSolverBodyPool[row->m_solverBodyIdB], *row);
}

void BulletRows::SweepPairByPair() {
  for (size_t i = 0; i + 1 < pairs_.size(); ++i) {
    const PairRows &begin = pairs_[i], &end = pairs_[i + 1];
    for (int j = begin.joints; j < end.joints; ++j) {
      const btSolverConstraint& row = m_tmpSolverNonContactConstraintPool[j];
      m_resolveSingleConstraintRowGeneric(m_tmpSolverBodyPool[row.m_solverBodyIdA],
                                          m_tmpSolverBodyPool[row.m_solverBodyIdB], row);
    }
    for (int j = begin.contacts; j < end.contacts; ++j) {
      const btSolverConstraint& row = m_tmpSolverContactConstraintPool[j];
      m_resolveSingleConstraintRowLowerLimit(m_tmpSolverBodyPool[row.m_solverBodyIdA],
                                             m_tmpSolverBodyPool[row.m_solverBodyIdB], row);
    }
    for (int j = begin.frictions; j < end.frictions; ++j) {
      SolveFriction(&m_tmpSolverContactFrictionConstraintPool[j]);
    }
  }
}

int BulletRows::rows() const {
  return pairs_.back().contacts + pairs_.back().frictions + pairs_.back().joints;
}

size_t BulletRows::bytes_per_sweep() const {
  constexpr size_t kBodyBytes =
      5 * sizeof(btVector3) + sizeof(btRigidBody*);  // velocities, factors, mass
  const bool joints = pairs_.back().joints > 0;
  const size_t visits = (pairs_.size() - 1) * (joints ? 1 : 2);
  return rows() * (sizeof(btSolverConstraint) + sizeof(int)) + visits * 2 * kBodyBytes;
}

size_t BulletRows::working_set() const {
  return rows() * (sizeof(btSolverConstraint) + sizeof(int)) +
         m_tmpSolverBodyPool.size() * sizeof(btSolverBody);
}

std::vector<float> BulletRows::Impulses() const {
  std::vector<float> impulses;
  for (size_t i = 0; i + 1 < pairs_.size(); ++i) {
    const PairRows &begin = pairs_[i], &end = pairs_[i + 1];
    AppendImpulses(m_tmpSolverNonContactConstraintPool, begin.joints, end.joints, &impulses);
    AppendImpulses(m_tmpSolverContactConstraintPool, begin.contacts, end.contacts, &impulses);
    AppendImpulses(m_tmpSolverContactFrictionConstraintPool, begin.frictions, end.frictions,
                   &impulses);
  }
  return impulses;
}

bool BulletRows::IsSound() const {
  for (int i = 0; i < m_tmpSolverBodyPool.size(); ++i) {
    const btSolverBody& body = m_tmpSolverBodyPool[i];
    for (const btVector3& v : {body.m_deltaLinearVelocity, body.m_deltaAngularVelocity}) {
      if (!AllSound({v.m_floats, 3})) return false;
    }
  }
  return AllSound(Impulses());
}

}  // namespace cairn::micro
