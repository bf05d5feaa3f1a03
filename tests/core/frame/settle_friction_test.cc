// SPDX-License-Identifier: MIT
// The sweeps of contacts that have not converged end with one over friction alone.
#include "sweep/settle_friction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "cairn/detail/eigen.h"
#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using test::Scene;
using test::Solution;

constexpr Path kPaths[] = {Path::kFast, Path::kReference};

/// So many sweeps and no look at the residual. Two settings, that differ by how sweeps end.
Settings Plain(Path path, int sweeps) {
  return {.method = Method::kPgs, .path = path, .max_sweeps = sweeps, .tolerance = 0};
}
Settings Settled(Path path, int sweeps) {
  return {.path = path,
          .k_sm = 0,
          .max_sweeps = sweeps,
          .tolerance = 0,
          .acceleration = Acceleration::kNone};
}

/// J v of one row.
double SpeedOf(const Row& row, const std::vector<Velocity>& v) {
  const auto half = [&](int body, const Vector3& linear, const Vector3& angular) {
    if (body == kWorld) return 0.0;
    return View(linear).dot(View(v[body].linear)) + View(angular).dot(View(v[body].angular));
  };
  return half(row.body_a, row.linear_a, row.angular_a) +
         half(row.body_b, row.linear_b, row.angular_b);
}

/// Squares of the speeds at which points slip although friction could hold them [m^2/s^2].
double Slip(const Scene& scene, const Solution& s) {
  double sum = 0;
  for (size_t i = 0; i < scene.rows.size(); ++i) {
    const Row& row = scene.rows[i];
    if (row.parent == kNoRow) continue;
    const bool holds = std::abs(s.x[i]) < 0.999 * row.friction * s.x[row.parent];
    if (holds) sum += std::pow(SpeedOf(row, s.v), 2);
  }
  return sum;
}

/// A tower that the wind leans on.
Scene PushedTower() {
  Scene scene = test::Tower(8);
  for (Body& body : scene.bodies) body.impulse[0] += 0.05 * body.impulse[1];
  return scene;
}

/// Contacts with friction, and joints; one island.
Scene JointedPile() { return test::RandomPile({.bodies = 6, .contacts = 20, .pins = 3}, 5); }

bool SameVelocities(const Velocity* a, const Velocity* b, size_t count) {
  return std::memcmp(a, b, count * sizeof(Velocity)) == 0;
}

TEST(SettledFriction, SlipsLess) {
  const Scene scene = PushedTower();
  for (const Path path : kPaths) {
    const double plain = Slip(scene, test::Solve(Plain(path, 6), scene));
    const double settled = Slip(scene, test::Solve(Settled(path, 6), scene));
    EXPECT_GT(plain, 0);
    EXPECT_LT(settled, 0.5 * plain);
  }
}

TEST(SettledFriction, IsNotWhereThereAreJoints) {
  const Scene scene = JointedPile();
  for (const Path path : kPaths) {
    const Solution plain = test::Solve(Plain(path, 6), scene);
    ASSERT_EQ(plain.report.islands.size(), 1u);
    EXPECT_TRUE(test::SameBits(test::Solve(Settled(path, 6), scene), plain));
  }
}

TEST(SettledFriction, IsNotUnderABudget) {
  const Scene scene = PushedTower();
  for (const Path path : kPaths) {
    Settings settings = Settled(path, 6);
    settings.budget = Budget::Work(1'000'000);
    EXPECT_TRUE(test::SameBits(test::Solve(settings, scene), test::Solve(Plain(path, 6), scene)));
  }
}

TEST(SettledFriction, LeavesWhatHasConverged) {
  const Scene scene = PushedTower();
  for (const Path path : kPaths) {
    Settings settings = Settled(path, 2000);
    settings.tolerance = 1e-3;
    const Solution s = test::Solve(settings, scene);
    ASSERT_EQ(s.report.stop, StopReason::kConverged);
    EXPECT_LE(s.report.residual_max, 1e-3);
  }
}

// Islands that share lanes, of which some have joints, and some have converged.
TEST(SettledFriction, OfAnIslandDoesNotSeeTheOthers) {
  const Scene parts[] = {PushedTower(), JointedPile(), test::Tower(1), test::Tower(5)};
  const Scene all = test::Together({parts[0], parts[1], parts[2], parts[3]});
  Settings settings = Settled(Path::kFast, 6);
  settings.tolerance = 1e-4;
  const Solution together = test::Solve(settings, all);
  size_t first = 0;
  for (const Scene& part : parts) {
    const Solution alone = test::Solve(settings, part);
    EXPECT_TRUE(SameVelocities(&together.v[first], alone.v.data(), alone.v.size())) << first;
    first += part.bodies.size();
  }
}

TEST(SettledFriction, HasTheSameBitsOnAnyNumberOfThreads) {
  const Scene scene = test::Wall(40, 40);
  Settings settings = Settled(Path::kFast, 6);
  const Solution one = test::Solve(settings, scene);
  settings.threads = 3;
  EXPECT_TRUE(test::SameBits(test::Solve(settings, scene), one));
}

}  // namespace
}  // namespace cairn
