// SPDX-License-Identifier: MIT
#include "contacts/split_impulse.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

const btRigidBody* RigidOf(int number, const BodyTable& bodies) {
  return number == kWorld ? nullptr : &bodies.rigid(number);
}

}  // namespace

void SplitImpulse::Add(const Push& push, btScalar over_relaxation, const BodyTable& bodies) {
  const btRigidBody* const a = RigidOf(push.body_a, bodies);
  const btRigidBody* const b = RigidOf(push.body_b, bodies);
  const Axes& axes = push.axes;
  const btScalar diagonal =
      ContactDiagonal(a, axes.angular_a) + ContactDiagonal(b, axes.angular_b) + push.compliance;
  if (!(diagonal > 0)) return;
  rows_.push_back({push, ResponseOf(a, axes.linear_a, axes.angular_a),
                   ResponseOf(b, axes.linear_b, axes.angular_b), over_relaxation / diagonal, 0});
}

void SplitImpulse::Solve(const btContactSolverInfo& info, int bodies) {
  velocities_.clear();
  if (rows_.empty()) return;
  velocities_.resize(bodies);
  for (int sweep = 0; sweep < info.m_numIterations; ++sweep) {
    btScalar largest = 0;
    for (PushRow& row : rows_) {
      const btScalar change = Relax(&row);
      largest = btMax(largest, change * change);
    }
    if (largest <= info.m_leastSquaresResidualThreshold) break;
  }
}

btScalar SplitImpulse::Relax(PushRow* row) {
  const Push& push = row->push;
  const bool has_a = push.body_a != kWorld, has_b = push.body_b != kWorld;
  btScalar speed = 0;
  if (has_a) {
    const PushVelocity& velocity = velocities_[push.body_a];
    speed += push.axes.linear_a.dot(velocity.linear) + push.axes.angular_a.dot(velocity.angular);
  }
  if (has_b) {
    const PushVelocity& velocity = velocities_[push.body_b];
    speed += push.axes.linear_b.dot(velocity.linear) + push.axes.angular_b.dot(velocity.angular);
  }
  const btScalar wanted = push.speed - speed - push.compliance * row->impulse;
  const btScalar sum = btMax(btScalar(0), row->impulse + wanted * row->step);
  const btScalar change = sum - row->impulse;
  row->impulse = sum;
  if (has_a) {
    velocities_[push.body_a].linear += row->response_a.linear * change;
    velocities_[push.body_a].angular += row->response_a.angular * change;
  }
  if (has_b) {
    velocities_[push.body_b].linear += row->response_b.linear * change;
    velocities_[push.body_b].angular += row->response_b.angular * change;
  }
  return change / row->step;
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
