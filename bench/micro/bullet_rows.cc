// SPDX-License-Identifier: MIT
#include "micro/bullet_rows.h"

#include <cmath>

#include "micro/sound.h"

namespace cairn::micro {
namespace {

using simd::RowBound;

using Pool = bench::PoolRow::Pool;

Eigen::Vector3d Response(const SceneBody& body, const Eigen::Vector3d& angular) {
  return body.root * (body.root.transpose() * angular);
}

void ClearImpulses(btConstraintArray* rows) {
  for (int i = 0; i < rows->size(); ++i) (*rows)[i].m_appliedImpulse = 0;
}

void AppendImpulses(const btConstraintArray& rows, int begin, int end, std::vector<float>* to) {
  for (int i = begin; i < end; ++i) to->push_back(rows[i].m_appliedImpulse);
}

}  // namespace

BulletRows::BulletRows(const RowScene& scene) {
  for (const SceneBody& body : scene.bodies) {
    AddBody({.moves = body.inv_mass > 0, .inv_mass = Eigen::Vector3d::Constant(body.inv_mass)});
  }
  for (const RowScene::Pair& pair : scene.pairs) {
    pairs_.push_back(NextRows());
    const int count = static_cast<int>(scene.layouts[pair.layout].size());
    for (int i = 0; i < count; ++i) AddSceneRow(scene, pair, i);
  }
  pairs_.push_back(NextRows());
  Begin();
}

BulletRows::PairRows BulletRows::NextRows() const {
  return {m_tmpSolverContactConstraintPool.size(), m_tmpSolverContactFrictionConstraintPool.size(),
          m_tmpSolverNonContactConstraintPool.size()};
}

void BulletRows::AddSceneRow(const RowScene& scene, const RowScene::Pair& pair, int index) {
  const SceneRow& row = scene.rows[pair.first_row + index];
  const simd::RowShape& shape = scene.layouts[pair.layout][index];
  const bool is_contact = shape.bound == RowBound::kPush;
  const bool is_friction = shape.bound == RowBound::kFriction;
  bench::PoolRow to;
  to.pool = is_contact ? Pool::kContact : is_friction ? Pool::kFriction : Pool::kJoint;
  to.body_a = pair.a;
  to.body_b = pair.b;
  to.linear_a = row.linear;
  to.angular_a = row.angular_a;
  if (pair.b != 0) to.linear_b = -row.linear;
  to.angular_b = row.angular_b;
  to.response_a = Response(scene.bodies[pair.a], row.angular_a);
  to.response_b = Response(scene.bodies[pair.b], row.angular_b);
  to.step = row.step;
  to.target = row.target;
  const double limit = shape.bound == RowBound::kFree ? INFINITY : row.limit;
  to.lo = is_contact ? 0 : -limit;
  to.hi = is_contact ? INFINITY : limit;
  to.friction = is_friction ? row.limit : 0;
  to.contact = is_friction ? pairs_.back().contacts + shape.parent : 0;
  AddRow(to);
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
