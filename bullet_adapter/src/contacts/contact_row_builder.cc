// SPDX-License-Identifier: MIT
#include "contacts/contact_row_builder.h"

#include <algorithm>

#include "conversions.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

double Target(btScalar speed) { return std::clamp<double>(speed, -kMostTarget, kMostTarget); }

}  // namespace

ContactTerms::ContactTerms(const btContactSolverInfo& info, SweepLimits limits)
    : time_step(info.m_timeStep),
      restitution_threshold(info.m_restitutionVelocityThreshold),
      splits(info.m_splitImpulse != 0),
      split_threshold(info.m_splitImpulsePenetrationThreshold),
      over_relaxation(info.m_sor) {
  row.relaxation = Relaxation(info.m_sor);
  if (limits == SweepLimits::kBullet) row.host.max_sweeps = info.m_numIterations;
}

void ContactRowBuilder::Append(const ManifoldInput& manifold) {
  if (manifold.points == 0) return;
  row_.body_a = manifold.body_a;
  row_.body_b = manifold.body_b;
  a_ = SideOf(manifold.body_a);
  b_ = SideOf(manifold.body_b);
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
  if (number == kWorld) return {nullptr, zero, zero, zero, zero};
  const Motion& motion = bodies_.motion(number);
  return {&bodies_.rigid(number), motion.velocity, motion.spin,
          motion.velocity + motion.external_velocity, motion.spin + motion.external_spin};
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

Row& ContactRowBuilder::AppendRow(const Axes& axes, double impulse) {
  Row& row = group_->Append(row_, impulse);
  row.linear_a = ToEigen(axes.linear_a);
  row.angular_a = ToEigen(axes.angular_a);
  row.linear_b = ToEigen(axes.linear_b);
  row.angular_b = ToEigen(axes.angular_b);
  return row;
}

/// The speed at which restitution lets the bodies part.
btScalar ContactRowBuilder::Bounce(const ContactInput& input, const Axes& axes) const {
  if (!(input.restitution > 0)) return 0;
  const btScalar speed = axes.linear_a.dot(a_.velocity) + axes.angular_a.dot(a_.spin) +
                         axes.linear_b.dot(b_.velocity) + axes.angular_b.dot(b_.spin);
  if (btFabs(speed) < terms_.restitution_threshold) return 0;
  return btMax(btScalar(0), -input.restitution * speed);
}

/// J v for friction: Bullet leaves out what torques add over the step.
btScalar ContactRowBuilder::TangentSpeed(const Axes& axes) const {
  return axes.linear_a.dot(a_.driven) + axes.angular_a.dot(a_.spin) + axes.linear_b.dot(b_.driven) +
         axes.angular_b.dot(b_.spin);
}

int ContactRowBuilder::AppendNormal(const ContactInput& input) {
  const Axes axes = AxesAlong(input.normal, input);
  const btScalar speed = axes.linear_a.dot(a_.driven) + axes.angular_a.dot(a_.driven_spin) +
                         axes.linear_b.dot(b_.driven) + axes.angular_b.dot(b_.driven_spin);
  btScalar target = Bounce(input, axes) - speed;
  if (input.distance > 0) {
    target -= input.distance / terms_.time_step;
  } else {
    const btScalar out = -input.distance * input.softness.erp / terms_.time_step;
    if (!terms_.splits || input.distance > terms_.split_threshold) {
      target += out;
    } else if (out != 0) {
      pushes_->Add({row_.body_a, row_.body_b, axes, out, input.softness.compliance},
                   terms_.over_relaxation, bodies_);
    }
  }
  Row& row = AppendRow(axes, input.normal_impulse);
  row.target = Target(target);
  row.compliance = input.softness.compliance;
  row.lo = 0;
  return static_cast<int>(group_->rows.size()) - 1;
}

void ContactRowBuilder::AppendFriction(const ContactInput& input, int tangents, PointRows* rows) {
  rows->friction_row = static_cast<int>(group_->rows.size());
  rows->frictions = tangents;
  for (int k = 0; k < tangents; ++k) {
    const Axes axes = AxesAlong(input.tangents[k], input);
    Row& row = AppendRow(axes, input.tangent_impulses[k]);
    row.target = Target(input.tangent_speeds[k] - TangentSpeed(axes));
    row.parent = rows->normal_row;
    row.friction = input.friction[k];
    if (input.slip == 0) continue;
    // Bullet has it in units of its step
    row.compliance =
        input.slip / terms_.over_relaxation *
        (ContactDiagonal(a_.rigid, axes.angular_a) + ContactDiagonal(b_.rigid, axes.angular_b));
  }
}

void ContactRowBuilder::AppendTwists(const ContactInput& input, PointRows* rows) {
  rows->twist_row = static_cast<int>(group_->rows.size());
  rows->twists = input.twists;
  const btVector3 zero(0, 0, 0);
  for (int k = 0; k < input.twists; ++k) {
    const Axes axes{zero, a_.rigid != nullptr ? -input.twist_axes[k] : zero, zero,
                    b_.rigid != nullptr ? input.twist_axes[k] : zero};
    Row& row = AppendRow(axes, input.twist_impulses[k]);
    row.relaxation = 1;
    row.target = Target(-TangentSpeed(axes));
    // bounded by the coefficient as well as by the coefficient times the normal impulse
    row.lo = -input.twist_limits[k];
    row.hi = input.twist_limits[k];
    row.parent = rows->normal_row;
    row.friction = input.twist_limits[k];
  }
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
