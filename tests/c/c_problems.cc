// SPDX-License-Identifier: MIT
#include "tests/c/c_problems.h"

namespace cairn::test {
namespace {

/// Copies numbers to floats, and takes what they lose from the original.
template <class Vector>
void Round(Vector* from, float* to) {
  for (int i = 0; i < 3; ++i) {
    to[i] = static_cast<float>((*from)[i]);
    (*from)[i] = to[i];
  }
}

CairnBody RoundBody(Body* from) {
  CairnBody to = cairnDefaultBody();
  to.invMass = static_cast<float>(from->inv_mass);
  from->inv_mass = to.invMass;
  for (int k = 0; k < 9; ++k) {
    to.invInertia[k] = static_cast<float>(from->inv_inertia(k / 3, k % 3));
    from->inv_inertia(k / 3, k % 3) = to.invInertia[k];
  }
  Round(&from->linear_factor, to.linearFactor);
  Round(&from->velocity.linear, to.velocity.linear);
  Round(&from->velocity.angular, to.velocity.angular);
  Round(&from->impulse, to.impulse);
  Round(&from->angular_impulse, to.angularImpulse);
  to.id = from->id;
  return to;
}

}  // namespace

CScene ToC(ManifoldScene* scene) {
  CScene result{.scene = scene,
                .bodies = {},
                .velocities = {},
                .problem = cairnDefaultProblem(),
                .solution = {}};
  for (Body& body : scene->bodies) result.bodies.push_back(RoundBody(&body));
  result.velocities.resize(scene->bodies.size());
  CairnProblem& problem = result.problem;
  const auto count = [](const auto& items) { return static_cast<int32_t>(items.size()); };
  problem.bodies = result.bodies.data();
  problem.bodyCount = count(result.bodies);
  problem.manifolds = reinterpret_cast<const CairnManifold*>(scene->manifolds.data());
  problem.manifoldCount = count(scene->manifolds);
  problem.points = reinterpret_cast<const CairnContactPoint*>(scene->points.data());
  problem.pointCount = count(scene->points);
  problem.twists = reinterpret_cast<const CairnContactTwist*>(scene->twists.data());
  problem.twistCount = count(scene->twists);
  problem.joints = reinterpret_cast<const CairnJoint*>(scene->joints.data());
  problem.jointCount = count(scene->joints);
  problem.jointRows = reinterpret_cast<const CairnJointRow*>(scene->joint_rows.data());
  problem.jointRowCount = count(scene->joint_rows);
  problem.bounceSpeed = scene->law.bounce_speed;
  result.solution = {reinterpret_cast<CairnContactImpulse*>(scene->point_impulses.data()),
                     reinterpret_cast<CairnTwistImpulse*>(scene->twist_impulses.data()),
                     scene->joint_impulses.data(), result.velocities.data()};
  return result;
}

}  // namespace cairn::test
