// SPDX-License-Identifier: MIT
#include "contacts/contact_points.h"

#include <algorithm>
#include <cstddef>

#include "cairn/detail/prefetch.h"
#include "conversions.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

void Put(const btVector3& from, float* to) {
  to[0] = static_cast<float>(from.x());
  to[1] = static_cast<float>(from.y());
  to[2] = static_cast<float>(from.z());
}

}  // namespace

void ContactPoints::Begin(const btContactSolverInfo& info, SweepLimits limits,
                          FrictionBounds bounds, const ContactSoftness& softness,
                          const ContactStart& start) {
  manifold_count_ = 0;
  count_ = 0;
  twists_.clear();
  twist_impulses_.clear();
  info_ = info;
  start_ = start;
  softness_ = softness;
  // below 0 all bounce
  law_ = {.bounce_speed = static_cast<float>(NotBelowZero(info.m_restitutionVelocityThreshold)),
          .host = {.spin_before_torques = true, .bounded_apart = bounds == FrictionBounds::kApart}};
  like_ = {.body_a = kWorld, .body_b = kWorld};
  like_.tangents = (info.m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS) != 0 ? 2 : 1;
  if (limits == SweepLimits::kBullet) like_.host.max_sweeps = info.m_numIterations;
  const bool by_velocity =
      (info.m_solverMode & SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION) == 0;
  takes_any_ = by_velocity && info.m_sor == 1;
  const bool by_user = (info.m_solverMode & SOLVER_ENABLE_FRICTION_DIRECTION_CACHING) != 0;
  not_taken_ = BT_CONTACT_FLAG_FRICTION_ANCHOR |
               (by_user ? BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED : 0);
}

void ContactPoints::End() {
  if (twists_.empty()) return;
  twists_.resize(count_);
  twist_impulses_.resize(count_);
}

void ContactPoints::MakeRoom(size_t more) {
  if (count_ + more <= points_.size()) return;
  const size_t size = std::max(2 * points_.size(), count_ + more);
  points_.resize(size);
  impulses_.resize(size);
  sources_.resize(size);
}

bool ContactPoints::Takes(const Ends& ends, const Features& found) const {
  return takes_any_ && !ends.a.slides_unevenly && !ends.b.slides_unevenly &&
         (found.flags & not_taken_) == 0 &&
         !(found.rolls && (ends.a.rolls_unevenly || ends.b.rolls_unevenly));
}

void ContactPoints::Describe(const Ends& ends, const Features& found, size_t first_point,
                             Manifold* to) const {
  *to = like_;
  to->body_a = ends.a.number;
  to->body_b = ends.b.number;
  to->first_point = static_cast<int>(first_point);
  to->points = static_cast<std::int8_t>(found.points);
  to->soft = found.soft;
  to->twists = found.rolls;
}

bool ContactPoints::Append(btPersistentManifold* manifold, BodyTable* bodies,
                           SplitImpulse* pushes) {
  if (manifold->getNumContacts() == 0) return true;
  const Ends ends{bodies->EndOf(*manifold->getBody0()), bodies->EndOf(*manifold->getBody1())};
  if (!Takes(ends, {})) return false;
  if (!ends.a.reacts && !ends.b.reacts) return true;
  MakeRoom(manifold->getNumContacts());
  const Features found = ReadPoints(ends, manifold, count_);
  if (!Takes(ends, found)) return false;
  if (found.points == 0) return true;

  if (manifold_count_ == manifolds_.size()) manifolds_.emplace_back();
  Describe(ends, found, count_, &manifolds_[manifold_count_++]);
  const size_t end = count_ + found.points;
  for (; count_ < end; ++count_) {
    if (found.pushed) AddPush(ends, *manifold, *sources_[count_], *bodies, pushes);
    if (found.rolls) AddTwist(count_);
  }
  return true;
}

ContactPoints::Features ContactPoints::ReadPoints(const Ends& ends, btPersistentManifold* manifold,
                                                  size_t place) {
  const int count = manifold->getNumContacts();
  const btScalar threshold = manifold->getContactProcessingThreshold();
  const Softness common = softness_.Of(*manifold);
  Features found;
  for (int i = 0; i < count; ++i) {
    btManifoldPoint& point = manifold->getContactPoint(i);
    if (!(point.getDistance() <= threshold)) continue;
    ReadPoint(ends, point, softness_.Of(point, common), place + found.points, &found);
    sources_[place + found.points] = &point;
    ++found.points;
  }
  return found;
}

/// Deep penetration is taken away beside the velocities.
bool ContactPoints::IsPushed(btScalar distance) const {
  return info_.m_splitImpulse != 0 &&
         distance <= btMin(btScalar(0), info_.m_splitImpulsePenetrationThreshold);
}

void ContactPoints::AddPush(const Ends& ends, const btPersistentManifold& manifold,
                            const btManifoldPoint& point, const BodyTable& bodies,
                            SplitImpulse* pushes) {
  const Softness softness = softness_.Of(point, softness_.Of(manifold));
  const btScalar distance = point.getDistance() + softness.slop;
  if (!IsPushed(distance)) return;
  const btScalar out = -distance * softness.erp / info_.m_timeStep;
  if (out == 0) return;
  const btVector3 zero(0, 0, 0), &normal = point.m_normalWorldOnB;
  Axes axes{zero, zero, zero, zero};
  if (ends.a.number != kWorld) {
    axes.linear_a = normal;
    axes.angular_a = (point.getPositionWorldOnA() - ends.a.origin()).cross(normal);
  }
  if (ends.b.number != kWorld) {
    axes.linear_b = -normal;
    axes.angular_b = (point.getPositionWorldOnB() - ends.b.origin()).cross(-normal);
  }
  pushes->Add({ends.a.number, ends.b.number, axes, out, softness.compliance}, info_.m_sor, bodies);
}

void ContactPoints::ReadPoint(const Ends& ends, const btManifoldPoint& source,
                              const Softness& softness, size_t place, Features* found) {
  const int flags = source.m_contactPointFlags;
  const btScalar distance = source.getDistance() + softness.slop;
  const bool pushed = IsPushed(distance);
  found->flags |= flags;
  found->pushed |= pushed;
  found->rolls |= source.m_combinedRollingFriction > 0;
  found->soft |= softness.compliance != 0;

  ContactPoint& point = points_[place];
  Put(source.getPositionWorldOnA() - ends.a.origin(), point.arm_a);
  Put(source.getPositionWorldOnB() - ends.b.origin(), point.arm_b);
  Put(source.m_normalWorldOnB, point.normal);
  Put({0, 0, 0}, point.tangent);
  const btScalar share = distance > 0 ? btScalar(1) : pushed ? btScalar(0) : softness.erp;
  point.bias = static_cast<float>(-distance * share / info_.m_timeStep);
  // Bullet never bounces bodies into each other
  point.restitution = static_cast<float>(btMax(btScalar(0), source.m_combinedRestitution));
  point.friction = static_cast<float>(btMax(btScalar(0), source.m_combinedFriction));
  point.compliance = static_cast<float>(softness.compliance);

  const btScalar second = like_.tangents > 1 ? source.m_appliedImpulseLateral2 : btScalar(0);
  impulses_[place] = {
      .normal = static_cast<float>(source.m_appliedImpulse * start_.normal),
      .tangential = {static_cast<float>(source.m_appliedImpulseLateral1 * start_.friction),
                     static_cast<float>(second * start_.friction)},
      .heading = static_cast<float>(source.m_prevRHS)};
}

void ContactPoints::AddTwist(size_t place) {
  const btManifoldPoint& source = *sources_[place];
  twists_.resize(place + 1);
  twist_impulses_.resize(place + 1);
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

void ContactPoints::Write(detail::Threads* threads) const {
  constexpr int kPointsOfPart = 512;
  const auto write = [this](int first, int count) { WritePart(first, first + count); };
  threads->For(static_cast<int>(count_), kPointsOfPart, write, {SpanKind::kWrite});
}

void ContactPoints::WritePart(size_t first, size_t end) const {
  const bool warm_starts = (info_.m_solverMode & SOLVER_USE_WARMSTARTING) != 0;
  const bool both = like_.tangents > 1;
  constexpr size_t kAhead = 12;
  // from the normal to the directions of friction
  constexpr size_t kLast = sizeof(btManifoldPoint) - offsetof(btManifoldPoint, m_normalWorldOnB);
  for (size_t i = first; i < end; ++i) {
    if (i + kAhead < count_) {
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
