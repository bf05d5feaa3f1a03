// SPDX-License-Identifier: MIT
#include "manifold_problems.h"
#include "cairn/detail/eigen.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>
#include <limits>

namespace cairn::test {
namespace {

void Put(const Vector3d& from, float* to) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

ContactPoint RandomPoint(const Vector3d& normal, Random* random) {
  ContactPoint point{};
  Put(random->Vector(1), point.arm_a);
  Put(random->Vector(1), point.arm_b);
  Put(normal, point.normal);
  if (random->Index(4) == 0) Put(normal.cross(random->Direction()).normalized(), point.tangent);
  point.bias = static_cast<float>(random->Uniform(-0.5, 0.5));
  point.restitution = static_cast<float>(random->Index(3) == 0 ? random->Uniform(0, 1) : 0);
  point.friction = static_cast<float>(random->Uniform(0, 1));
  point.compliance = static_cast<float>(random->Uniform(0, 0.1));
  return point;
}

ContactImpulse RandomImpulse(Random* random) {
  ContactImpulse impulse;
  impulse.normal = static_cast<float>(random->Uniform(-0.2, 1));
  for (float& x : impulse.tangential) x = static_cast<float>(random->Uniform(-0.3, 0.3));
  impulse.heading = static_cast<float>(random->Uniform(0.5, 5));
  return impulse;
}

}  // namespace

ManifoldScene RandomManifolds(int bodies, int manifolds, std::uint64_t seed) {
  Random random(seed);
  ManifoldScene scene;
  for (int i = 0; i < bodies; ++i) scene.bodies.push_back(RandomBody(&random));
  // kinematic, and one that does not move evenly
  scene.bodies[0].inv_mass = 0;
  View(scene.bodies[0].inv_inertia).setZero();
  scene.bodies[1].linear_factor = {1, 0.5, 0};
  scene.law = {.bounce_speed = 0.2f,
               .host = {.spin_before_torques = seed % 2 == 0, .bounded_apart = seed % 5 == 0}};
  for (int i = 0; i < bodies && seed % 3 == 0; ++i) {
    ContactMotion& motion = scene.motions.emplace_back();
    for (float* vector :
         {motion.free_velocity, motion.free_spin, motion.start_velocity, motion.start_spin}) {
      Put(random.Vector(2), vector);
    }
  }
  for (int i = 0; i < manifolds; ++i) {
    Manifold manifold{.body_a = random.Index(bodies), .body_b = random.Index(bodies)};
    if (random.Index(6) == 0) manifold.body_b = kWorld;
    if (manifold.body_a == manifold.body_b) manifold.body_b = kWorld;
    if (random.Index(2) == 0) std::swap(manifold.body_a, manifold.body_b);
    manifold.first_point = static_cast<int>(scene.points.size());
    manifold.points = static_cast<std::int8_t>(1 + random.Index(4));
    manifold.tangents = static_cast<std::int8_t>(random.Index(3));
    manifold.soft = random.Index(3) == 0;
    scene.manifolds.push_back(manifold);
    const Vector3d normal = random.Direction();
    for (int p = 0; p < manifold.points; ++p) {
      scene.points.push_back(RandomPoint(normal, &random));
      scene.point_impulses.push_back(RandomImpulse(&random));
    }
  }
  return scene;
}

ManifoldScene RollingManifolds(int bodies, int manifolds, std::uint64_t seed) {
  ManifoldScene scene = RandomManifolds(bodies, manifolds, seed);
  Random random(seed + 1000);
  const auto number = [&random](double lo, double hi) {
    return static_cast<float>(random.Uniform(lo, hi));
  };
  for (Manifold& manifold : scene.manifolds) manifold.twists = random.Index(2) == 0;
  for (size_t i = 0; i < scene.points.size(); ++i) {
    const float most = random.Index(3) == 0 ? std::numeric_limits<float>::infinity() : 0.05f;
    scene.twists.push_back({.spinning = number(0, 0.2),
                            .rolling = random.Index(4) == 0 ? 0 : number(0, 0.3),
                            .most_spinning = most,
                            .most_rolling = number(0, 0.1)});
    scene.twist_impulses.push_back(
        {.spinning = number(-0.2, 0.2), .rolling = {number(-0.2, 0.2), number(-0.2, 0.2)}});
  }
  return scene;
}

void AddJoints(int joints, std::uint64_t seed, ManifoldScene* scene) {
  Random random(seed + 2000);
  const auto number = [&random](double lo, double hi) {
    return static_cast<float>(random.Uniform(lo, hi));
  };
  const int bodies = static_cast<int>(scene->bodies.size());
  for (int i = 0; i < joints; ++i) {
    Joint joint{.body_a = random.Index(bodies), .body_b = random.Index(bodies)};
    if (random.Index(6) == 0 || joint.body_a == joint.body_b) joint.body_b = kWorld;
    if (random.Index(2) == 0) std::swap(joint.body_a, joint.body_b);
    joint.first_row = static_cast<int>(scene->joint_rows.size());
    joint.rows = 1 + random.Index(8);
    joint.soft = random.Index(3) == 0;
    joint.opposite = random.Index(2) == 0;
    joint.damping = random.Index(3) == 0 ? number(0, 1) : 1;
    for (int k = 0; k < joint.rows; ++k) {
      JointRow& row = scene->joint_rows.emplace_back();
      const bool turns = random.Index(3) == 0;
      if (turns) joint.angular |= 1u << k;
      if (random.Index(3) == 0) joint.bounded |= 1u << k;
      const Vector3d push = turns ? Vector3d(0, 0, 0) : random.Direction();
      Put(push, row.linear_a);
      Put(joint.opposite || turns ? Vector3d(-push) : random.Direction(), row.linear_b);
      Put(random.Vector(1), row.angular_a);
      Put(random.Vector(1), row.angular_b);
      row.target = number(-0.5, 0.5);
      row.compliance = number(0, 0.1);
      row.lo = number(-0.5, 0.1);
      row.hi = random.Index(3) == 0 ? std::numeric_limits<float>::infinity() : number(0.1, 0.5);
      scene->joint_impulses.push_back(number(-0.5, 0.5));
    }
    scene->joints.push_back(joint);
  }
}

ManifoldScene ManifoldTower(int boxes) {
  ManifoldScene scene;
  for (int i = 0; i < boxes; ++i) {
    scene.bodies.push_back(Box(1, {1, 1, 1}));
    scene.bodies.back().impulse = {0, -kGravityStep, 0};
    Manifold manifold{.body_a = i, .body_b = i - 1};
    manifold.first_point = 4 * i;
    manifold.points = 4;
    scene.manifolds.push_back(manifold);
    for (int p = 0; p < 4; ++p) {
      const float x = (p & 1) != 0 ? 0.5f : -0.5f, z = (p & 2) != 0 ? 0.5f : -0.5f;
      scene.points.push_back({.arm_a = {x, -0.5f, z},
                              .arm_b = {x, 0.5f, z},
                              .normal = {0, 1, 0},
                              .tangent = {0, 0, 0},
                              .bias = 0,
                              .restitution = 0,
                              .friction = 0.5f,
                              .compliance = 0});
    }
  }
  scene.point_impulses.resize(scene.points.size());
  return scene;
}

bool SameTwist(const TwistImpulse& a, const TwistImpulse& b) {
  return std::memcmp(&a, &b, sizeof(TwistImpulse)) == 0;
}

testing::AssertionResult SameBits(std::span<const ContactImpulse> a,
                                  std::span<const ContactImpulse> b) {
  if (a.size() != b.size()) return testing::AssertionFailure() << "sizes differ";
  for (size_t i = 0; i < a.size(); ++i) {
    if (std::memcmp(&a[i], &b[i], sizeof(ContactImpulse)) == 0) continue;
    return testing::AssertionFailure() << "point " << i;
  }
  return testing::AssertionSuccess();
}

}  // namespace cairn::test
