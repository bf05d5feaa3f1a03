// SPDX-License-Identifier: MIT
#include "contact_points.h"

#include <cstddef>

#include "cairn/prefetch.h"
#include "conversions.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

void Put(const btVector3& from, float* to) {
  to[0] = static_cast<float>(from.x());
  to[1] = static_cast<float>(from.y());
  to[2] = static_cast<float>(from.z());
}

bool EitherIsAnisotropic(const btPersistentManifold& manifold, int mode) {
  return manifold.getBody0()->hasAnisotropicFriction(mode) ||
         manifold.getBody1()->hasAnisotropicFriction(mode);
}

}  // namespace

void ContactPoints::Begin(const btContactSolverInfo& info, SweepLimits limits,
                          const ContactStart& start) {
  manifolds_.clear();
  points_.clear();
  impulses_.clear();
  twists_.clear();
  twist_impulses_.clear();
  sources_.clear();
  info_ = info;
  start_ = start;
  law_ = {.bounce_speed = static_cast<float>(info.m_restitutionVelocityThreshold),
          .spin_before_torques = true};
  like_ = {.body_a = kWorld, .body_b = kWorld};
  like_.tangents = (info.m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS) != 0 ? 2 : 1;
  if (limits == SweepLimits::kBullet) like_.max_sweeps = info.m_numIterations;
  const bool by_velocity =
      (info.m_solverMode & SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION) == 0;
  takes_any_ = by_velocity && info.m_sor == 1;
}

void ContactPoints::End() {
  if (twists_.empty()) return;
  twists_.resize(points_.size());
  twist_impulses_.resize(points_.size());
}

ContactPoints::Kind ContactPoints::KindOf(const btPersistentManifold& manifold) const {
  using Object = btCollisionObject;
  if (!takes_any_ || EitherIsAnisotropic(manifold, Object::CF_ANISOTROPIC_FRICTION)) {
    return Kind::kNotTaken;
  }
  bool rolls = false;
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    if (!IsPlain(point)) return Kind::kNotTaken;
    rolls = rolls || point.m_combinedRollingFriction > 0;
  }
  if (!rolls) return Kind::kPlain;
  return EitherIsAnisotropic(manifold, Object::CF_ANISOTROPIC_ROLLING_FRICTION) ? Kind::kNotTaken
                                                                                : Kind::kRolling;
}

bool ContactPoints::IsPlain(const btManifoldPoint& point) const {
  const bool by_user =
      (info_.m_solverMode & SOLVER_ENABLE_FRICTION_DIRECTION_CACHING) != 0 &&
      (point.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED) != 0;
  const bool anchored = (point.m_contactPointFlags & BT_CONTACT_FLAG_FRICTION_ANCHOR) != 0;
  return !by_user && !anchored;
}

bool ContactPoints::Append(btPersistentManifold* manifold, BodyTable* bodies,
                           SplitImpulse* pushes) {
  const int count = manifold->getNumContacts();
  if (count == 0) return true;
  const Kind kind = KindOf(*manifold);
  if (kind == Kind::kNotTaken) return false;

  Manifold next = like_;
  next.twists = kind == Kind::kRolling;
  next.body_a = bodies->Number(*manifold->getBody0());
  next.body_b = bodies->Number(*manifold->getBody1());
  if (!bodies->reacts(next.body_a) && !bodies->reacts(next.body_b)) return true;
  next.first_point = static_cast<int>(points_.size());
  const Ends ends{next.body_a, next.body_b, manifold->getBody0()->getWorldTransform().getOrigin(),
                  manifold->getBody1()->getWorldTransform().getOrigin()};
  const btScalar threshold = manifold->getContactProcessingThreshold();
  for (int i = 0; i < count; ++i) {
    btManifoldPoint& point = manifold->getContactPoint(i);
    if (!(point.getDistance() <= threshold)) continue;
    AppendPoint(ends, &point);
    if (next.twists) AddTwist(point);
    if (IsPushed(point)) AddPush(ends, point, *bodies, pushes);
  }
  next.points = static_cast<std::int8_t>(static_cast<int>(points_.size()) - next.first_point);
  for (int p = next.first_point; p < static_cast<int>(points_.size()); ++p) {
    next.soft = next.soft || points_[p].compliance != 0;
  }
  if (next.points > 0) manifolds_.push_back(next);
  return true;
}

/// Deep penetration is taken away beside the velocities.
bool ContactPoints::IsPushed(const btManifoldPoint& point) const {
  const btScalar distance = point.getDistance() + info_.m_linearSlop;
  return info_.m_splitImpulse != 0 &&
         distance <= btMin(btScalar(0), info_.m_splitImpulsePenetrationThreshold);
}

void ContactPoints::AddPush(const Ends& ends, const btManifoldPoint& point, const BodyTable& bodies,
                            SplitImpulse* pushes) {
  const Softness softness = SoftnessOf(point, info_);
  const btScalar distance = point.getDistance() + info_.m_linearSlop;
  const btScalar out = -distance * softness.erp / info_.m_timeStep;
  if (out == 0) return;
  const btVector3 zero(0, 0, 0), &normal = point.m_normalWorldOnB;
  Axes axes{zero, zero, zero, zero};
  if (ends.body_a != kWorld) {
    axes.linear_a = normal;
    axes.angular_a = (point.getPositionWorldOnA() - ends.origin_a).cross(normal);
  }
  if (ends.body_b != kWorld) {
    axes.linear_b = -normal;
    axes.angular_b = (point.getPositionWorldOnB() - ends.origin_b).cross(-normal);
  }
  pushes->Add({ends.body_a, ends.body_b, axes, out, softness.compliance}, info_.m_sor, bodies);
}

void ContactPoints::AppendPoint(const Ends& ends, btManifoldPoint* source) {
  const Softness softness = SoftnessOf(*source, info_);
  const btScalar distance = source->getDistance() + info_.m_linearSlop;
  const btScalar share = distance > 0 ? btScalar(1) : IsPushed(*source) ? 0 : softness.erp;
  ContactPoint& point = points_.emplace_back();
  Put(source->getPositionWorldOnA() - ends.origin_a, point.arm_a);
  Put(source->getPositionWorldOnB() - ends.origin_b, point.arm_b);
  Put(source->m_normalWorldOnB, point.normal);
  point.bias = static_cast<float>(-distance * share / info_.m_timeStep);
  // Bullet never bounces bodies into each other
  point.restitution = static_cast<float>(btMax(btScalar(0), source->m_combinedRestitution));
  point.friction = static_cast<float>(btMax(btScalar(0), source->m_combinedFriction));
  point.compliance = static_cast<float>(softness.compliance);

  impulses_.push_back(
      {.normal = static_cast<float>(source->m_appliedImpulse * start_.normal),
       .tangential = {static_cast<float>(source->m_appliedImpulseLateral1 * start_.friction),
                      like_.tangents > 1
                          ? static_cast<float>(source->m_appliedImpulseLateral2 * start_.friction)
                          : 0.0f},
       .heading = static_cast<float>(source->m_prevRHS)});
  sources_.push_back(source);
}

void ContactPoints::AddTwist(const btManifoldPoint& source) {
  twists_.resize(points_.size());
  twist_impulses_.resize(points_.size());
  // spinning friction counts only together with rolling friction, and the coefficient is also the
  // most that there is
  if (!(source.m_combinedRollingFriction > 0)) return;
  const auto rolling = static_cast<float>(source.m_combinedRollingFriction);
  const auto spinning = static_cast<float>(btMax(btScalar(0), source.m_combinedSpinningFriction));
  twists_.back() = {spinning, rolling, spinning, rolling};
  if (start_.twists == nullptr || start_.friction == 0) return;
  // rows of Bullet turn the second body
  const TwistMemory::Impulses left = start_.twists->Find(source);
  const auto start = [&](int k) { return static_cast<float>(-left[k] * start_.friction); };
  twist_impulses_.back() = {.spinning = start(0), .rolling = {start(1), start(2)}};
}

void ContactPoints::Keep(TwistMemory* memory) const {
  for (size_t i = 0; i < twists_.size(); ++i) {
    if (!(twists_[i].rolling > 0)) continue;
    const TwistImpulse& impulse = twist_impulses_[i];
    memory->Keep(*sources_[i], {-impulse.spinning, -impulse.rolling[0], -impulse.rolling[1]});
  }
}

void ContactPoints::Write() const {
  const bool warm_starts = (info_.m_solverMode & SOLVER_USE_WARMSTARTING) != 0;
  const bool both = like_.tangents > 1;
  constexpr size_t kAhead = 12;
  // from the normal to the directions of friction
  constexpr size_t kLast = sizeof(btManifoldPoint) - offsetof(btManifoldPoint, m_normalWorldOnB);
  for (size_t i = 0; i < sources_.size(); ++i) {
    if (i + kAhead < sources_.size()) {
      Prefetch(&sources_[i + kAhead]->m_normalWorldOnB, kLast);
    }
    btManifoldPoint& point = *sources_[i];
    const ContactImpulse& impulse = impulses_[i];
    const float* const t1 = impulse.direction;
    point.m_lateralFrictionDir1.setValue(t1[0], t1[1], t1[2]);
    if (both) {
      point.m_lateralFrictionDir2 = point.m_lateralFrictionDir1.cross(point.m_normalWorldOnB);
    }
    if (!warm_starts) continue;
    point.m_appliedImpulse = impulse.normal;
    point.m_appliedImpulseLateral1 = impulse.tangential[0];
    if (both) point.m_appliedImpulseLateral2 = impulse.tangential[1];
    point.m_prevRHS = impulse.heading;
  }
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
