// SPDX-License-Identifier: MIT
#include "cairn/bullet/group_rows.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cstdint>

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

/// Bounds of at least this size are Bullet's way to say infinity [N s].
constexpr double kUnbounded = 1e10;
/// Targets beyond this stand for infinity, which 6dof springs ask for; they can only end at a
/// bound.
constexpr double kMostTarget = 1e12;

Eigen::Vector3d ToEigen(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

btVector3 ToBullet(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

Eigen::Matrix3d ToEigen(const btMatrix3x3& m) {
  Eigen::Matrix3d result;
  for (int i = 0; i < 3; ++i) result.row(i) = ToEigen(m[i]).transpose();
  return result;
}

double Bound(btScalar value) {
  if (value >= kUnbounded) return kInfinity;
  if (value <= -kUnbounded) return -kInfinity;
  return value;
}

/// Kinematic bodies do not react, whatever mass they were given.
bool Reacts(const btSolverBody& body) {
  return body.m_originalBody != nullptr && !body.m_originalBody->isStaticOrKinematicObject();
}

Body ToBody(const btSolverBody& source) {
  Body body;
  if (!Reacts(source)) return body;
  const btRigidBody& rigid = *source.m_originalBody;
  const Eigen::Vector3d angular_factor = ToEigen(rigid.getAngularFactor());
  body.inv_mass = rigid.getInvMass();
  body.linear_factor = ToEigen(rigid.getLinearFactor()).cwiseAbs();
  body.inv_inertia = angular_factor.asDiagonal() * ToEigen(rigid.getInvInertiaTensorWorld()) *
                     angular_factor.asDiagonal();
  body.id = static_cast<std::uint64_t>(std::max(0, rigid.getWorldArrayIndex() + 1));
  return body;
}

/// Step lengths that a sweep can be made with; where Bullet's diverges, the exact one.
double Relaxation(double factor) { return factor > 0 && factor < 1.99 ? factor : 1.0; }

}  // namespace

void GroupRows::Read(const RowPools& pools, const btContactSolverInfo& info, SweepLimits limits) {
  rows_.clear();
  impulses_.clear();
  sources_.clear();
  ReadBodies(pools);
  ReadJoints(pools, info, limits);
  ReadContacts(pools, info, limits);
}

void GroupRows::ReadBodies(const RowPools& pools) {
  bodies_.resize(pools.bodies->size());
  for (int i = 0; i < pools.bodies->size(); ++i) bodies_[i] = ToBody((*pools.bodies)[i]);
  velocities_.assign(bodies_.size(), Velocity{});
}

int GroupRows::ReadRow(btSolverConstraint* source, const Row& law) {
  Row row = law;
  row.body_a = source->m_solverBodyIdA;
  row.body_b = source->m_solverBodyIdB;
  row.linear_a = ToEigen(source->m_contactNormal1);
  row.angular_a = ToEigen(source->m_relpos1CrossNormal);
  row.linear_b = ToEigen(source->m_contactNormal2);
  row.angular_b = ToEigen(source->m_relpos2CrossNormal);

  // Bullet keeps target and compliance premultiplied by its step D
  const double step = source->m_jacDiagABInv;
  if (step > 0) {
    row.target = std::clamp(source->m_rhs / step, -kMostTarget, kMostTarget);
    row.compliance = source->m_cfm / step;
  }

  rows_.push_back(row);
  impulses_.push_back(source->m_appliedImpulse);
  sources_.push_back(source);
  return static_cast<int>(rows_.size()) - 1;
}

void GroupRows::ReadJoints(const RowPools& pools, const btContactSolverInfo& info,
                           SweepLimits limits) {
  for (int i = 0; i < pools.joints->size(); ++i) {
    btSolverConstraint& source = (*pools.joints)[i];
    // Bullet's D leaves the cfm of a joint out
    Row law{.lo = Bound(source.m_lowerLimit),
            .hi = Bound(source.m_upperLimit),
            .relaxation = Relaxation(1 + source.m_cfm)};
    if (limits == SweepLimits::kBullet) {
      const int own = source.m_overrideNumSolverIterations;
      law.max_sweeps = own > 0 ? own : info.m_numIterations;
    }
    ReadRow(&source, law);
  }
}

void GroupRows::ReadContacts(const RowPools& pools, const btContactSolverInfo& info,
                             SweepLimits limits) {
  const Row unlimited;
  const double relaxation = Relaxation(info.m_sor);
  const int max_sweeps =
      limits == SweepLimits::kBullet ? info.m_numIterations : unlimited.max_sweeps;
  const bool interleaved = (info.m_solverMode & SOLVER_INTERLEAVE_CONTACT_AND_FRICTION_CONSTRAINTS);
  std::vector<int> row_of_contact(pools.contacts->size());
  const auto read_friction = [&](int i) {
    btSolverConstraint& source = (*pools.frictions)[i];
    ReadRow(&source, {.parent = row_of_contact[source.m_frictionIndex],
                      .friction = std::max<double>(0, source.m_friction),
                      .relaxation = relaxation,
                      .max_sweeps = max_sweeps});
  };

  int friction = 0;
  for (int i = 0; i < pools.contacts->size(); ++i) {
    row_of_contact[i] = ReadRow(&(*pools.contacts)[i],
                                {.lo = 0, .relaxation = relaxation, .max_sweeps = max_sweeps});
    while (interleaved && friction < pools.frictions->size() &&
           (*pools.frictions)[friction].m_frictionIndex == i) {
      read_friction(friction++);
    }
  }
  while (friction < pools.frictions->size()) read_friction(friction++);

  // rolling friction is bounded by mu as well as by mu times the normal impulse
  for (int i = 0; i < pools.rolling->size(); ++i) {
    btSolverConstraint& source = (*pools.rolling)[i];
    const double most = std::max<double>(0, source.m_friction);
    ReadRow(&source, {.lo = -most,
                      .hi = most,
                      .parent = row_of_contact[source.m_frictionIndex],
                      .friction = most,
                      .max_sweeps = max_sweeps});
  }
}

void GroupRows::Write(const RowPools& pools) const {
  for (size_t i = 0; i < sources_.size(); ++i) {
    sources_[i]->m_appliedImpulse = static_cast<btScalar>(impulses_[i]);
  }
  for (int i = 0; i < pools.bodies->size(); ++i) {
    btSolverBody& body = (*pools.bodies)[i];
    // kinematic bodies too: their change is zero, where Bullet's warm start may have moved them
    if (body.m_originalBody == nullptr) continue;
    body.m_deltaLinearVelocity = ToBullet(velocities_[i].linear);
    body.m_deltaAngularVelocity = ToBullet(velocities_[i].angular);
  }
}

void GroupRows::ReadVelocities(const RowPools& pools) {
  for (int i = 0; i < pools.bodies->size(); ++i) {
    const btSolverBody& body = (*pools.bodies)[i];
    if (!Reacts(body)) continue;
    velocities_[i].linear = ToEigen(body.m_deltaLinearVelocity);
    velocities_[i].angular = ToEigen(body.m_deltaAngularVelocity);
  }
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
