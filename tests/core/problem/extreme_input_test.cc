// SPDX-License-Identifier: MIT
// Contact problems at the ends of what is allowed: a result is finite, inside its bounds and as the
// report says, or the status says that there is none and nothing was written.
#include <gtest/gtest.h>

#include <chrono>
#include <climits>
#include <cmath>
#include <limits>
#include <vector>

#include "cairn/detail/eigen.h"
#include "cairn/solver.h"
#include "tests/core/support/test_clock.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

/// A ball of 1 kg at @p ball_speed [m/s] up, and a platform without mass that moves at 2 m/s up.
std::vector<Body> BallAndPlatform(double ball_speed = -1) {
  std::vector<Body> bodies(2);
  bodies[0].inv_mass = 1;
  bodies[0].inv_inertia = 2 * Eigen::Matrix3d::Identity();
  bodies[0].velocity.linear = Vector3d(0, ball_speed, 0);
  bodies[1].velocity.linear = Vector3d(0, 2, 0);
  return bodies;
}

/// It pushes body @p a up against body @p b.
Row Push(int a, int b) {
  Row row;
  row.body_a = a;
  row.body_b = b;
  row.linear_a = Vector3d(0, 1, 0);
  row.linear_b = -View(row.linear_a);
  row.lo = 0;
  return row;
}

Row TurnedRound(const Row& row) {
  Row turned = row;
  std::swap(turned.body_a, turned.body_b);
  std::swap(turned.linear_a, turned.linear_b);
  std::swap(turned.angular_a, turned.angular_b);
  return turned;
}

struct Solved {
  Report report;
  std::vector<double> x;
  std::vector<Velocity> velocities;
};

Solved Solve(const std::vector<Body>& bodies, const std::vector<Row>& rows,
             const Settings& settings = {}) {
  Solved solved{{}, std::vector<double>(rows.size()), std::vector<Velocity>(bodies.size())};
  Solver solver(settings);
  solved.report = solver.Solve({.bodies = bodies, .rows = rows}, solved.x, solved.velocities);
  return solved;
}

TEST(UnmovedBody, CarriesABallAtItsOwnSpeed) {
  const std::vector<Body> bodies = BallAndPlatform();
  for (const Row& row : {Push(0, 1), TurnedRound(Push(0, 1))}) {
    for (Path path : {Path::kFast, Path::kReference}) {
      const Solved solved = Solve(bodies, {row}, {.path = path});
      ASSERT_TRUE(solved.report.ok());
      // 1 kg from -1 m/s to 2 m/s
      EXPECT_NEAR(solved.x[0], 3, 1e-6);
      EXPECT_NEAR(solved.velocities[0].linear.y(), 2, 1e-6);
    }
  }
}

TEST(UnmovedBody, SharesAPairWithTheWorldAndKeepsItsSpeedToItself) {
  // one ball between the ground and the platform: plain rows against both are one pair of blocks
  std::vector<Body> bodies = BallAndPlatform();
  bodies[1].velocity.angular = Vector3d(0, 0, 3);
  Row side;
  side.body_a = 0;
  side.body_b = 1;
  side.linear_a = Vector3d(1, 0, 0);
  side.linear_b = -View(side.linear_a);
  side.angular_b = Vector3d(0, 0, 0.5);  // the platform turns: 1.5 m/s
  Row ground = Push(0, kWorld);
  const std::vector<Row> rows = {ground, side, Push(0, 1)};
  const Solved solved = Solve(bodies, rows, {.path = Path::kFast});
  ASSERT_TRUE(solved.report.ok());
  EXPECT_NEAR(solved.velocities[0].linear.y(), 2, 1e-6);
  EXPECT_NEAR(solved.velocities[0].linear.x(), -1.5, 1e-6);
  const Report measured = Measure({.bodies = bodies, .rows = rows}, solved.x);
  EXPECT_LT(measured.residual_max, 1e-5);  // floats
}

TEST(UnmovedBody, CountsWhereBothBodiesAreUnmoved) {
  // nothing moves, so only the compliance can satisfy it: w = -2 + x / 4 = 0
  std::vector<Body> bodies(2);
  bodies[1].velocity.linear = Vector3d(0, 2, 0);
  for (Row row : {Push(0, 1), TurnedRound(Push(0, 1))}) {
    row.compliance = 0.25;
    for (Path path : {Path::kFast, Path::kReference}) {
      EXPECT_NEAR(Solve(bodies, {row}, {.path = path}).x[0], 8, 1e-5);
    }
  }
}

TEST(ManyFactorisations, AreRefusedBeyondAThousandAndTakeNoTimeBelow) {
  std::vector<Body> bodies(6);
  std::vector<Row> rows;
  for (int i = 0; i < 6; ++i) {
    bodies[i].inv_mass = 1;
    View(bodies[i].inv_inertia).setIdentity();
    bodies[i].velocity.linear = {1, 2.0 * i, 3};
    for (int k = 0; k < 3; ++k) {
      Row& row = rows.emplace_back();
      row.body_a = i;
      row.body_b = i - 1;
      row.linear_a = Vector3d::Unit(k);
      row.linear_b = -View(row.linear_a);
    }
  }
  EXPECT_EQ(Solve(bodies, rows, {.k_sm = INT_MAX}).report.status, Status::kBadSettings);
  EXPECT_EQ(Solve(bodies, rows, {.tuning = {.refinements = INT_MAX}}).report.status,
            Status::kBadSettings);
  Settings settings{.k_sm = 1000};
  settings.k_gs = INT_MAX;
  settings.budget = Budget::Time(std::chrono::milliseconds(2));
  settings.tuning.refinements = 1000;
  for (Path path : {Path::kFast, Path::kReference}) {
    settings.path = path;
    const test::ScriptedClock clock = test::TickingClock(std::chrono::microseconds(2));
    settings.tuning.clock = &clock;
    const Report report = Solve(bodies, rows, settings).report;
    EXPECT_TRUE(report.ok());
    // a step may be begun at the end; it was 27 s
    EXPECT_LT(clock.looks(), 1000 + 50);
    EXPECT_LE(report.factorisations, 2 * 1000);
  }
}

TEST(ExtremeNumbers, AreSolvedOrRefusedAndNeverHalfWritten) {
  // masses, lever arms and speeds in all combinations of decades
  const double decades[] = {0, 1e-300, 1e-160, 1e-40, 1e-20, 1e-9,
                            1, 1e9,    1e20,   1e40,  1e160, 1e300};
  int solved_count = 0;
  for (double inv_mass : decades) {
    for (double speed : decades) {
      for (double lever : decades) {
        std::vector<Body> bodies = BallAndPlatform(-speed);
        bodies[0].inv_mass = inv_mass;
        Row row = Push(0, kWorld);
        row.angular_a = Vector3d(lever, 0, 0);
        const Solved solved = Solve(bodies, {row});
        const bool finite = std::isfinite(solved.x[0]) &&
                            View(solved.velocities[0].linear).allFinite() &&
                            View(solved.velocities[0].angular).allFinite();
        EXPECT_TRUE(finite);
        if (!solved.report.ok()) {
          EXPECT_EQ(solved.report.status, Status::kOverflow);
          EXPECT_EQ(solved.report.stop, StopReason::kBrokeDown);
          EXPECT_EQ(solved.report.bad_body, 0);
          EXPECT_EQ(solved.x[0], 0);
          EXPECT_TRUE(View(solved.velocities[0].linear).isZero(0));
          continue;
        }
        ++solved_count;
        const double scale = std::max(1.0, speed);
        EXPECT_NEAR(solved.report.residual_max / scale, 0, 1e-5)
            << inv_mass << ' ' << speed << ' ' << lever;
      }
    }
  }
  EXPECT_GT(solved_count, 100);
}

TEST(ExtremeNumbers, TooLargeForAnImpulseInFloatsAreRefused) {
  // 1e30 kg at 1e20 m/s: fine in double precision, not in the floats of a point
  std::vector<Body> bodies = BallAndPlatform(-1e20);
  bodies[0].inv_mass = 1e-30;
  View(bodies[0].inv_inertia).setZero();
  std::vector<Manifold> manifolds = {{.body_a = 0, .body_b = kWorld}};
  ContactPoint point{};
  point.normal[1] = 1;
  std::vector<ContactPoint> points = {point};
  std::vector<ContactImpulse> x = {{.normal = 3}};
  std::vector<Velocity> velocities(2);
  Solver solver;
  const ContactProblem problem{
      .bodies = bodies, .rows = {}, .manifolds = manifolds, .points = points};
  const Report report = solver.Solve(problem, Impulses{.rows = {}, .points = x}, velocities);
  EXPECT_EQ(report.status, Status::kOverflow);
  EXPECT_EQ(x[0].normal, 3);
  EXPECT_TRUE(View(velocities[0].linear).isZero(0));
  EXPECT_TRUE(report.islands.empty());
}

TEST(OwnBounds, HoldToTheLastBitAfterLargeImpulses) {
  // the start is far outside, so that the change of the first sweep swallows what is small
  std::vector<Body> bodies = BallAndPlatform(-1);
  for (double start : {1e3, -1e3, 1e7, 3e9}) {
    std::vector<Row> rows;
    for (double bound : {0.1, 0.01, 0.3, 1e-7}) {
      Row& row = rows.emplace_back(Push(0, 1));
      row.lo = -bound;
      row.hi = bound;
    }
    Row& joint = rows.emplace_back(Push(0, 1));
    joint.lo = -kInfinity;
    std::vector<double> x(rows.size(), start);
    std::vector<Velocity> velocities(2);
    for (int sweeps : {0, 1, 2, 10}) {
      Solver solver({.path = Path::kFast, .max_sweeps = sweeps});
      ASSERT_TRUE(solver.Solve({.bodies = bodies, .rows = rows}, x, velocities).ok());
      for (size_t i = 0; i < rows.size(); ++i) {
        EXPECT_GE(x[i], rows[i].lo);
        EXPECT_LE(x[i], rows[i].hi);
      }
    }
  }
}

TEST(BodyIds, ThatLeadToThemselvesDoNotHoldUpTheSolver) {
  // k = 6364136223846793005 k + 4 modulo 2^64 for the second island, whose first body is number 3
  std::uint64_t id = 0;
  const std::uint64_t factor = (6364136223846793005u - 1) / 4;  // odd: it has an inverse
  std::uint64_t inverse = factor;
  for (int i = 0; i < 6; ++i) inverse *= 2 - factor * inverse;
  id = 0 - inverse;
  ASSERT_EQ(id * 6364136223846793005u + 4, id);
  std::vector<Body> bodies(4);
  std::vector<Row> rows;
  for (int i : {0, 3}) {
    bodies[i].inv_mass = 1;
    bodies[i].id = id;
    rows.push_back(Push(i, kWorld));
  }
  for (Path path : {Path::kFast, Path::kReference}) {
    EXPECT_TRUE(Solve(bodies, rows, {.path = path}).report.ok());
  }
}

}  // namespace
}  // namespace cairn
