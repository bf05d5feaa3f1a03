// SPDX-License-Identifier: MIT
#include "contacts/contact_softness.h"

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>

#include "conversions.h"
#include "gravity.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

// Chosen on heavy tops and growing towers; see docs/lab/steps.md, Towers that rock.

/// A contact rests from this age on [s]: the time after which Bullet lets bodies sleep.
constexpr auto kRestsFrom = btScalar(2);
/// For so long it becomes gentler [s]: it must not be seen.
constexpr auto kSettles = btScalar(2);
/// How deep it then rests, of the way of a body in the first step of its fall.
constexpr auto kSlop = btScalar(0.1);
/// How much of the ERP of the world it then has.
constexpr auto kErp = btScalar(0.75);

/// Longer steps are followed by this part of the difference, in each step.
constexpr auto kFollows = btScalar(64);

/// How often Bullet has looked at the oldest point of a manifold since it was found.
int LooksAt(const btPersistentManifold& manifold) {
  int looks = 0;
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    looks = std::max(looks, manifold.getContactPoint(i).getLifeTime());
  }
  return looks;
}

/// How often Bullet looks at the points of a manifold in a step: those of compounds twice.
int LooksInStep(const btPersistentManifold& manifold) {
  const auto is_compound = [](const btCollisionObject& object) {
    return object.getCollisionShape()->isCompound();
  };
  return is_compound(*manifold.getBody0()) || is_compound(*manifold.getBody1()) ? 2 : 1;
}

}  // namespace

btScalar RestingStep::Next(btScalar time_step) {
  if (!(time_step > 0)) return step_;
  const bool shorter = step_ == 0 || time_step < step_;
  step_ = shorter ? time_step : step_ + (time_step - step_) / kFollows;
  return step_;
}

ContactSoftness::ContactSoftness(const btContactSolverInfo& info, const Options& options,
                                 btScalar resting_step)
    : time_step_(info.m_timeStep),
      resting_step_(resting_step),
      cfm_(info.m_globalCfm),
      world_{.erp = info.m_erp2,
             .compliance = NotBelowZero(info.m_globalCfm) / info.m_timeStep,
             .slop = info.m_linearSlop},
      rests_(options.resting_slop && info.m_linearSlop == 0) {}

Softness ContactSoftness::Rest(const btPersistentManifold& manifold) const {
  const int looks = LooksAt(manifold);
  if (!(btScalar(looks) * resting_step_ > kRestsFrom)) return world_;
  const btScalar age = btScalar(looks) / btScalar(LooksInStep(manifold)) * resting_step_;
  if (!(age > kRestsFrom)) return world_;
  const btScalar gravity = btMax(GravityOf(manifold.getBody0()), GravityOf(manifold.getBody1()));
  if (gravity == 0) return world_;
  const btScalar part = btMin((age - kRestsFrom) / kSettles, btScalar(1));
  Softness softness = world_;
  softness.slop = part * kSlop * gravity * resting_step_ * resting_step_;
  softness.erp *= 1 - part * (1 - kErp);
  return softness;
}

Softness ContactSoftness::Own(const btManifoldPoint& point) const {
  btScalar cfm = cfm_, erp = world_.erp;
  const int flags = point.m_contactPointFlags;
  if ((flags & (BT_CONTACT_FLAG_HAS_CONTACT_CFM | BT_CONTACT_FLAG_HAS_CONTACT_ERP)) != 0) {
    if ((flags & BT_CONTACT_FLAG_HAS_CONTACT_CFM) != 0) cfm = point.m_contactCFM;
    if ((flags & BT_CONTACT_FLAG_HAS_CONTACT_ERP) != 0) erp = point.m_contactERP;
  } else {
    const btScalar spring = time_step_ * point.m_combinedContactStiffness1;
    const btScalar sum = btMax(spring + point.m_combinedContactDamping1, SIMD_EPSILON);
    cfm = 1 / sum;
    erp = spring / sum;
  }
  return {.erp = erp, .compliance = NotBelowZero(cfm) / time_step_, .slop = world_.slop};
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
