// SPDX-License-Identifier: MIT
// Sweeps that build on each other, without steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "cairn/detail/eigen.h"
#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using test::Scene;
using test::Solution;

Settings Sweeps(Acceleration acceleration, int sweeps) {
  Settings settings = test::Coloured(sweeps);
  settings.method = Method::kPgsSm;
  settings.k_sm = 0;
  settings.acceleration = acceleration;
  return settings;
}

int SweepsTo(double tolerance, Acceleration acceleration, const Scene& scene) {
  Settings settings = Sweeps(acceleration, 20000);
  settings.tolerance = tolerance;
  const Solution s = test::Solve(settings, scene);
  EXPECT_EQ(s.report.stop, StopReason::kConverged);
  EXPECT_LE(Measure(scene.problem(), s.x).residual_max, 1.1 * tolerance);
  return s.report.sweeps;
}

/// The method in plain loops and doubles: so many sweeps over rows of point masses, in this order.
/// @param most_beta  1, or 0 for sweeps that do not build on each other
std::vector<double> PlainNncg(const Scene& scene, const std::vector<int>& order, int sweeps,
                              double most_beta) {
  const auto inv_mass = [&](int body) { return body == kWorld ? 0 : scene.bodies[body].inv_mass; };
  const auto start = [&](int body) -> Eigen::Vector3d {
    if (body == kWorld) return {0, 0, 0};
    return View(scene.bodies[body].velocity.linear) +
           inv_mass(body) * View(scene.bodies[body].impulse);
  };
  // w = J v - target of a row, with v from all impulses
  const auto w = [&](const Row& row, const std::vector<double>& x) {
    Eigen::Vector3d a = start(row.body_a), b = start(row.body_b);
    for (size_t j = 0; j < x.size(); ++j) {
      const Row& other = scene.rows[j];
      for (const auto& [body, v] : {std::pair(row.body_a, &a), std::pair(row.body_b, &b)}) {
        if (body == kWorld) continue;
        if (other.body_a == body) *v += inv_mass(body) * x[j] * View(other.linear_a);
        if (other.body_b == body) *v += inv_mass(body) * x[j] * View(other.linear_b);
      }
    }
    return View(row.linear_a).dot(a) + View(row.linear_b).dot(b) - row.target;
  };

  // what a change of impulses does to the velocity of a body
  const auto moves = [&](int body, const std::vector<double>& dx) {
    Eigen::Vector3d v(0, 0, 0);
    for (size_t j = 0; j < dx.size(); ++j) {
      const Row& row = scene.rows[j];
      if (row.body_a == body) v += inv_mass(body) * dx[j] * View(row.linear_a);
      if (row.body_b == body) v += inv_mass(body) * dx[j] * View(row.linear_b);
    }
    return v;
  };

  std::vector<double> x(scene.rows.size()), last = x, along(x.size()), done(x.size());
  double beta = 0, keep = 0, before = 0;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    // a sweep that goes back on its direction: anew
    for (size_t i = 0; i < x.size(); ++i) done[i] = x[i] - last[i];
    double progress = 0;
    for (int body = 0; body < static_cast<int>(scene.bodies.size()); ++body) {
      progress += moves(body, done).dot(moves(body, along)) / inv_mass(body);
    }
    if (progress < 0) beta = keep = 0;
    // on along what the last ones changed
    for (size_t i = 0; i < x.size(); ++i) {
      x[i] += beta * along[i];
      along[i] = keep * (x[i] - last[i]);
    }
    last = x;

    // a sweep of projected Gauss-Seidel, its steps measured in energy
    double energy = 0;
    for (int i : order) {
      const Row& row = scene.rows[i];
      const double d = inv_mass(row.body_a) * View(row.linear_a).squaredNorm() +
                       inv_mass(row.body_b) * View(row.linear_b).squaredNorm();
      const double most = row.parent == kNoRow ? 0 : row.friction * std::max(0.0, x[row.parent]);
      const double lo = row.parent == kNoRow ? row.lo : -most;
      const double hi = row.parent == kNoRow ? row.hi : most;
      const double to = std::clamp(x[i] - w(row, x) / d, lo, hi);
      energy += d * (to - x[i]) * (to - x[i]);
      x[i] = to;
    }

    // the ratio of Fletcher and Reeves; where steps grow, anew
    const double ratio = before == 0 ? 0 : energy / before;
    beta = ratio <= 1 ? most_beta * ratio : 0;
    keep = ratio <= 1 ? 1 : 0;
    before = energy;
  }
  return x;
}

/// A mass on the ground, a second one on it that is pushed aside, and a third that hangs on both.
Scene ThreeMasses() {
  Scene scene;
  scene.bodies = {test::PointMass(1, {0.3, 0, -0.2}), test::PointMass(4, {1.5, 0.2, -0.7}),
                  test::PointMass(0.5, {-0.1, 0.4, -0.3})};
  scene.rows = {test::PushRow(0, kWorld, {0, 0, 1}), test::PushRow(1, 0, {0, 0, 1}),
                test::LinearRow(1, 0, {1, 0, 0}), test::LinearRow(2, 1, {0.6, 0, 0.8}),
                test::LinearRow(2, 0, {0, 0.6, 0.8})};
  scene.rows[2].parent = 1;
  scene.rows[2].friction = 0.6;
  return scene;
}

/// The largest distance of plain loops in this order to what blocks make, after some sweeps.
double DistanceToBlocks(const Scene& scene, const std::vector<int>& order, double most_beta) {
  double most = 0;
  for (const int sweeps : {1, 3, 4, 7, 12}) {
    Settings settings = Sweeps(Acceleration::kNncg, sweeps);
    settings.k_gs = sweeps;  // the state after all of them, not the best on the momentum
    const Solution blocks = test::Solve(settings, scene);
    EXPECT_EQ(blocks.report.sweeps, sweeps);
    most = std::max(most, test::Distance(blocks.x, PlainNncg(scene, order, sweeps, most_beta)));
  }
  return most;
}

// Blocks sweep the rows in an order of their own, which is one of all that there are. Floats round
// impulses of 1 N s by 1e-7 in each of a dozen sweeps.
TEST(Nncg, IsWhatThePlainLoopsSay) {
  const Scene scene = ThreeMasses();
  std::vector<int> order = {0, 1, 2, 3, 4};
  double nearest = kInfinity, nearest_without = kInfinity;
  do {
    nearest = std::min(nearest, DistanceToBlocks(scene, order, 1));
    nearest_without = std::min(nearest_without, DistanceToBlocks(scene, order, 0));
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_LE(nearest, 5e-6);
  EXPECT_GE(nearest_without, 1e-3);
}

/// Some masses in a row, each held by two springs and by three rows to the one before it.
Scene MassesOnSprings(double softness, test::Random* random) {
  Scene scene;
  const int masses = 2 + random->Index(5);
  const auto add = [&](int a, int b, double compliance) {
    scene.rows.push_back(test::LinearRow(a, b, random->Direction()));
    scene.rows.back().compliance = compliance;
  };
  for (int i = 0; i < masses; ++i) {
    scene.bodies.push_back(test::PointMass(std::exp(random->Uniform(0, 3)), random->Vector(4)));
    for (int k = 0; k < 2; ++k) add(i, kWorld, softness * std::exp(random->Uniform(-2, 2)));
    for (int k = 0; k < 3 && i > 0; ++k) add(i, i - 1, 0.1 * softness);
  }
  return scene;
}

// Errors shrink by no more than the momentum lets them, and it is chosen by how they shrink: what
// began badly went on so. One of these ended ten sweeps with 97 times the error of plain ones.
TEST(Nncg, DoesNotKeepABadPace) {
  test::Random random(1);
  double logarithms = 0, worst = 0;
  int count = 0;
  for (const double softness : {0., 0.05, 0.3, 1.}) {
    for (int i = 0; i < 200; ++i, ++count) {
      const Scene scene = MassesOnSprings(softness, &random);
      const auto error_after_ten = [&scene](Acceleration acceleration) {
        // floats err by about that
        constexpr double kRounding = 1e-6;
        return kRounding + test::Solve(Sweeps(acceleration, 10), scene).report.residual_energy;
      };
      const double ratio =
          error_after_ten(Acceleration::kNncg) / error_after_ten(Acceleration::kNone);
      logarithms += std::log(ratio);
      worst = std::max(worst, ratio);
    }
  }
  EXPECT_LE(worst, 10);
  EXPECT_LE(std::exp(logarithms / count), 0.65);
}

// Conjugate gradients take the root of the steps that plain descent takes where all rows are free,
// as in a chain; contacts make them start anew now and then.
TEST(Nncg, TakesFewerSweepsWhereErrorsTravelFar) {
  const auto ratio = [](const Scene& scene) {
    return SweepsTo(1e-3, Acceleration::kNone, scene) / SweepsTo(1e-3, Acceleration::kNncg, scene);
  };
  EXPECT_GE(ratio(test::HangingChain(40, 10)), 8);
  EXPECT_GE(ratio(test::Tower(20)), 2);
  EXPECT_GE(ratio(test::Wall(12, 12)), 2);
}

TEST(Nncg, LeavesMethodsThatSayWhatTheyAreAlone) {
  const Scene scene = test::Wall(6, 6);
  for (const Method method : {Method::kPgs, Method::kPsor}) {
    Settings with = Sweeps(Acceleration::kNncg, 20), without = Sweeps(Acceleration::kNone, 20);
    with.method = without.method = method;
    EXPECT_TRUE(test::SameBits(test::Solve(with, scene), test::Solve(without, scene)));
  }
  EXPECT_FALSE(test::SameBits(test::Solve(Sweeps(Acceleration::kNncg, 20), scene),
                              test::Solve(Sweeps(Acceleration::kNone, 20), scene)));
}

// What was moved out of its bounds must not be what the caller gets, wherever a budget ends.
TEST(Nncg, EndsInsideTheBoundsAfterAnyWork) {
  const Scene scene = test::WithEveryLaw(
      test::Heap({.bodies = 150, .contacts = 400, .pins = 10, .world_share = 0.3}, 5), 5);
  const int sweep = static_cast<int>(scene.rows.size());
  for (int work = 1; work < 30 * sweep; work += sweep / 3 + 1) {
    Settings settings = Sweeps(Acceleration::kNncg, 1000);
    settings.budget = Budget::Work(work);
    settings.tuning.min_sweeps = 0;
    const Solution s = test::Solve(settings, scene);
    ASSERT_TRUE(s.report.ok());
    for (size_t i = 0; i < scene.rows.size(); ++i) {
      const Row& row = scene.rows[i];
      const double rounding = 1e-6 * std::abs(s.x[i]);
      ASSERT_GE(s.x[i], row.lo - rounding) << "row " << i << ", work " << work;
      ASSERT_LE(s.x[i], row.hi + rounding) << "row " << i << ", work " << work;
      // what takes part in few sweeps does not follow its parent after those
      if (row.parent == kNoRow || row.host.max_sweeps < 1000) continue;
      const double most = row.friction * std::max(0.0, s.x[row.parent]);
      ASSERT_LE(std::abs(s.x[i]), most + rounding + 1e-12) << "row " << i << ", work " << work;
    }
  }
}

TEST(Nncg, KeepsVelocitiesConsistentWithImpulses) {
  const Scene scene = test::Wall(8, 8);
  const Solution s = test::Solve(Sweeps(Acceleration::kNncg, 200), scene);
  EXPECT_NEAR(Measure(scene.problem(), s.x).residual_max, s.report.residual_max,
              1e-5 + 1e-2 * s.report.residual_max);
}

}  // namespace
}  // namespace cairn
