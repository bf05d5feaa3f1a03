// SPDX-License-Identifier: MIT
#include "contact_rows.h"

#include <algorithm>

#include "conversions.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

double Target(btScalar speed) { return std::clamp<double>(speed, -kMostTarget, kMostTarget); }

}  // namespace

ContactLaw::ContactLaw(const btContactSolverInfo& info, SweepLimits limits)
    : time_step(info.m_timeStep),
      restitution_threshold(info.m_restitutionVelocityThreshold),
      splits(info.m_splitImpulse != 0),
      split_threshold(info.m_splitImpulsePenetrationThreshold),
      over_relaxation(info.m_sor) {
  row.relaxation = Relaxation(info.m_sor);
  if (limits == SweepLimits::kBullet) row.max_sweeps = info.m_numIterations;
}

void ContactRowBuilder::Append(const ManifoldInput& manifold) {
  if (manifold.points == 0) return;
  body_a_ = manifold.body_a;
  body_b_ = manifold.body_b;
  a_ = SideOf(body_a_);
  b_ = SideOf(body_b_);
  const size_t first = group_->points.size();
  for (int i = 0; i < manifold.points; ++i) {
    const ContactInput& input = manifold.inputs[i];
    group_->points.push_back({input.point, AppendNormal(input), kNoRow, kNoRow, 0, 0, input.left});
  }
  PointRows* const points = &group_->points[first];
  for (int i = 0; i < manifold.points; ++i) {
    AppendFriction(manifold.inputs[i], manifold.tangents, &points[i]);
  }
  for (int i = 0; i < manifold.points; ++i) AppendTwists(manifold.inputs[i], &points[i]);
}

ContactRowBuilder::Side ContactRowBuilder::SideOf(int number) const {
  const btVector3 zero(0, 0, 0);
  if (number == kWorld) return {nullptr, {zero, zero, zero, zero}};
  return {&bodies_.rigid(number), bodies_.motion(number)};
}

Axes ContactRowBuilder::AxesAlong(const btVector3& direction, const ContactInput& input) const {
  const btVector3 zero(0, 0, 0);
  Axes axes{zero, zero, zero, zero};
  if (a_.rigid != nullptr) {
    axes.linear_a = direction;
    axes.angular_a = input.arm_a.cross(direction);
  }
  if (b_.rigid != nullptr) {
    axes.linear_b = -direction;
    axes.angular_b = input.arm_b.cross(-direction);
  }
  return axes;
}

Row ContactRowBuilder::RowOf(const Axes& axes) const {
  Row row = law_.row;
  row.body_a = body_a_;
  row.body_b = body_b_;
  row.linear_a = ToEigen(axes.linear_a);
  row.angular_a = ToEigen(axes.angular_a);
  row.linear_b = ToEigen(axes.linear_b);
  row.angular_b = ToEigen(axes.angular_b);
  return row;
}

/// J v with the velocities before the step, of which a share bounces.
btScalar ContactRowBuilder::SpeedBefore(const Axes& axes) const {
  return axes.linear_a.dot(a_.motion.velocity) + axes.angular_a.dot(a_.motion.spin) +
         axes.linear_b.dot(b_.motion.velocity) + axes.angular_b.dot(b_.motion.spin);
}

/// J v with what forces and torques add over the step.
btScalar ContactRowBuilder::NormalSpeed(const Axes& axes) const {
  return axes.linear_a.dot(a_.motion.velocity + a_.motion.external_velocity) +
         axes.angular_a.dot(a_.motion.spin + a_.motion.external_spin) +
         axes.linear_b.dot(b_.motion.velocity + b_.motion.external_velocity) +
         axes.angular_b.dot(b_.motion.spin + b_.motion.external_spin);
}

/// The same for friction: Bullet leaves out what torques add.
btScalar ContactRowBuilder::TangentSpeed(const Axes& axes) const {
  return axes.linear_a.dot(a_.motion.velocity + a_.motion.external_velocity) +
         axes.angular_a.dot(a_.motion.spin) +
         axes.linear_b.dot(b_.motion.velocity + b_.motion.external_velocity) +
         axes.angular_b.dot(b_.motion.spin);
}

/// The speed at which restitution lets the bodies part.
btScalar ContactRowBuilder::Bounce(const ContactInput& input, const Axes& axes) const {
  const btScalar speed = SpeedBefore(axes);
  if (btFabs(speed) < law_.restitution_threshold) return 0;
  return btMax(btScalar(0), -input.restitution * speed);
}

int ContactRowBuilder::AppendNormal(const ContactInput& input) {
  const Axes axes = AxesAlong(input.normal, input);
  btScalar target = Bounce(input, axes) - NormalSpeed(axes);
  if (input.distance > 0) {
    target -= input.distance / law_.time_step;
  } else {
    const btScalar out = -input.distance * input.erp / law_.time_step;
    if (!law_.splits || input.distance > law_.split_threshold) {
      target += out;
    } else if (out != 0) {
      pushes_->Add({body_a_, body_b_, axes, out, input.compliance}, law_.over_relaxation, bodies_);
    }
  }
  Row row = RowOf(axes);
  row.target = Target(target);
  row.compliance = input.compliance;
  row.lo = 0;
  return group_->Add(row, input.normal_impulse);
}

void ContactRowBuilder::AppendFriction(const ContactInput& input, int tangents, PointRows* rows) {
  rows->friction_row = static_cast<int>(group_->rows.size());
  rows->frictions = tangents;
  for (int k = 0; k < tangents; ++k) {
    const Axes axes = AxesAlong(input.tangents[k], input);
    Row row = RowOf(axes);
    row.target = Target(input.tangent_speeds[k] - TangentSpeed(axes));
    if (input.slip != 0) {
      // Bullet has it in units of its step
      row.compliance =
          input.slip / law_.over_relaxation *
          (ContactDiagonal(a_.rigid, axes.angular_a) + ContactDiagonal(b_.rigid, axes.angular_b));
    }
    row.parent = rows->normal_row;
    row.friction = input.friction;
    group_->Add(row, input.tangent_impulses[k]);
  }
}

void ContactRowBuilder::AppendTwists(const ContactInput& input, PointRows* rows) {
  rows->twist_row = static_cast<int>(group_->rows.size());
  rows->twists = input.twists;
  const btVector3 zero(0, 0, 0);
  for (int k = 0; k < input.twists; ++k) {
    const Axes axes{zero, a_.rigid != nullptr ? -input.twist_axes[k] : zero, zero,
                    b_.rigid != nullptr ? input.twist_axes[k] : zero};
    Row row = RowOf(axes);
    row.relaxation = 1;
    row.target = Target(-TangentSpeed(axes));
    // bounded by the coefficient as well as by the coefficient times the normal impulse
    row.lo = -input.twist_limits[k];
    row.hi = input.twist_limits[k];
    row.parent = rows->normal_row;
    row.friction = input.twist_limits[k];
    group_->Add(row, 0);
  }
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
