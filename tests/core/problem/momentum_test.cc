// SPDX-License-Identifier: MIT
// Rows between bodies act and react at the same point: whatever the solver does, the sums of linear
// momentum and of angular momentum about the origin stay those of the bodies without constraints.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "cairn/detail/eigen.h"
#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using test::Scene;
using test::Solution;

struct Momentum {
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
  double linear_size = 0, angular_size = 0;  ///< of the parts: rounding is relative to these
};

Momentum MomentumOf(const Scene& scene, const std::vector<Velocity>& velocities) {
  Momentum sum;
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    const Vector3d p = View(velocities[i].linear) / scene.bodies[i].inv_mass;
    const Vector3d spin = View(scene.bodies[i].inv_inertia).inverse() * View(velocities[i].angular);
    const Vector3d orbit = scene.positions[i].cross(p);
    sum.linear += p;
    sum.angular += spin + orbit;
    sum.linear_size += p.norm();
    sum.angular_size += spin.norm() + orbit.norm();
  }
  return sum;
}

void ExpectConserved(const Scene& scene, const Solution& solution) {
  // impulses zero, nothing solved: velocities without constraints
  const Solution free = test::Solve(test::PlainSweeps(0), scene);
  const Momentum before = MomentumOf(scene, free.v), after = MomentumOf(scene, solution.v);
  // some hundred roundings of 1e-16 for each body
  EXPECT_LT((after.linear - before.linear).norm(), 1e-12 * after.linear_size);
  EXPECT_LT((after.angular - before.angular).norm(), 1e-12 * after.angular_size);
  EXPECT_GT(test::Distance(solution.v, free.v), 0.01) << "nothing happened";
}

/// Free in space: no row to the world.
Scene FreePile(std::uint64_t seed) {
  return test::RandomPile({.bodies = 10, .contacts = 15, .pins = 5, .world_share = 0}, seed);
}

TEST(Momentum, IsConservedBySweeps) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Scene scene = FreePile(seed);
    for (int sweeps : {1, 10, 200}) {
      ExpectConserved(scene, test::Solve(test::PlainSweeps(sweeps), scene));
    }
  }
}

TEST(Momentum, IsConservedByStepsKeptAndUndone) {
  int accepted = 0, restored = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Scene scene = FreePile(seed);
    for (int sweeps : {10, 50}) {
      const Solution s = test::Solve(test::AlwaysSteps(sweeps), scene);
      ExpectConserved(scene, s);
      accepted += s.report.steps_accepted;
      restored += s.report.steps_restored;
    }
  }
  EXPECT_GT(accepted, 20);
  EXPECT_GT(restored, 20);
}

TEST(Momentum, IsConservedFromAWarmStartAndWithinABudget) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Scene scene = FreePile(seed);
    // too much of what three sweeps make, and not so much that it is guarded
    std::vector<double> start = test::Solve(test::PlainSweeps(3), scene).x;
    for (double& x : start) x *= 1.2;
    for (int work : {0, 30, 100, 3000}) {
      Settings settings = test::AlwaysSteps(100);
      settings.budget = Budget::Work(work);
      ExpectConserved(scene, test::Solve(settings, scene, start));
    }
  }
}

}  // namespace
}  // namespace cairn
