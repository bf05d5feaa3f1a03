// SPDX-License-Identifier: MIT
#include "cairn/bullet/detail/group_rows.h"

#include <algorithm>

#include "body_table.h"
#include "conversions.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

bool MayReact(const btSolverBody& body) {
  return body.m_originalBody != nullptr && Reacts(*body.m_originalBody);
}

bool HasFactors(const btSolverBody& body) {
  const btVector3 all(1, 1, 1);
  return MayReact(body) && (body.m_originalBody->getLinearFactor() != all ||
                            body.m_originalBody->getAngularFactor() != all);
}

/// J M^-1 J' of one side of a row, without the factors of its body and with them.
struct Diagonals {
  double without = 0, with = 0;

  void Add(const btSolverBody& body, const btVector3& linear, const btVector3& angular) {
    if (!MayReact(body)) return;
    const btRigidBody& rigid = *body.m_originalBody;
    without += HalfDiagonal(rigid, linear, angular);
    with += HalfDiagonal(rigid, btVector3(0, 0, 0), angular * rigid.getAngularFactor()) +
            (linear * linear).dot(rigid.getLinearFactor().absolute()) * rigid.getInvMass();
  }
};

/// What factors of bodies leave of the diagonal of a row. Bullet's step leaves them out: along
/// locked axes it is a small part of the exact one.
double ShareOfFactors(const btSolverConstraint& row, double compliance, const RowPools& pools) {
  const btSolverBody &a = (*pools.bodies)[row.m_solverBodyIdA],
                     &b = (*pools.bodies)[row.m_solverBodyIdB];
  if (!HasFactors(a) && !HasFactors(b)) return 1;
  Diagonals diagonals;
  diagonals.Add(a, row.m_contactNormal1, row.m_relpos1CrossNormal);
  diagonals.Add(b, row.m_contactNormal2, row.m_relpos2CrossNormal);
  const double without = diagonals.without + compliance;
  return without > 0 ? (diagonals.with + compliance) / without : 1;
}

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
  for (int i = 0; i < pools.bodies->size(); ++i) {
    const btSolverBody& body = (*pools.bodies)[i];
    bodies_[i] = {};
    if (!MayReact(body)) continue;
    bodies_[i] = ToBody(*body.m_originalBody);
    const int place = body.m_originalBody->getWorldArrayIndex();
    bodies_[i].id = static_cast<std::uint64_t>(std::max(0, place + 1));
  }
  velocities_.assign(bodies_.size(), Velocity{});
}

int GroupRows::ReadRow(const RowPools& pools, const Row& common, btSolverConstraint* source) {
  Row row = common;
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
    row.relaxation = Relaxation(row.relaxation * ShareOfFactors(*source, row.compliance, pools));
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
    Row common{.lo = Bound(source.m_lowerLimit),
               .hi = Bound(source.m_upperLimit),
               .relaxation = Relaxation(1 + source.m_cfm)};
    if (limits == SweepLimits::kBullet) {
      const int own = source.m_overrideNumSolverIterations;
      common.host.max_sweeps = own > 0 ? own : info.m_numIterations;
    }
    ReadRow(pools, common, &source);
  }
}

void GroupRows::ReadContacts(const RowPools& pools, const btContactSolverInfo& info,
                             SweepLimits limits) {
  const Row unlimited;
  const double relaxation = Relaxation(info.m_sor);
  const int max_sweeps =
      limits == SweepLimits::kBullet ? info.m_numIterations : unlimited.host.max_sweeps;
  const bool interleaved = (info.m_solverMode & SOLVER_INTERLEAVE_CONTACT_AND_FRICTION_CONSTRAINTS);
  std::vector<int> row_of_contact(pools.contacts->size());
  const auto read_friction = [&](int i) {
    btSolverConstraint& source = (*pools.frictions)[i];
    ReadRow(pools,
            {.parent = row_of_contact[source.m_frictionIndex],
             .friction = std::max<double>(0, source.m_friction),
             .relaxation = relaxation,
             .host = {.max_sweeps = max_sweeps}},
            &source);
  };

  int friction = 0;
  for (int i = 0; i < pools.contacts->size(); ++i) {
    row_of_contact[i] =
        ReadRow(pools, {.lo = 0, .relaxation = relaxation, .host = {.max_sweeps = max_sweeps}},
                &(*pools.contacts)[i]);
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
    ReadRow(pools,
            {.lo = -most,
             .hi = most,
             .parent = row_of_contact[source.m_frictionIndex],
             .friction = most,
             .host = {.max_sweeps = max_sweeps}},
            &source);
  }
}

bool GroupRows::FitsBullet() const {
  btScalar zero = 0;
  for (const double impulse : impulses_) zero += 0 * static_cast<btScalar>(impulse);
  for (const Velocity& velocity : velocities_) {
    for (int k = 0; k < 3; ++k) {
      zero += 0 * static_cast<btScalar>(velocity.linear[k]);
      zero += 0 * static_cast<btScalar>(velocity.angular[k]);
    }
  }
  return zero == 0;
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
    if (!MayReact(body)) continue;
    velocities_[i].linear = ToEigen(body.m_deltaLinearVelocity);
    velocities_[i].angular = ToEigen(body.m_deltaAngularVelocity);
  }
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
