// SPDX-License-Identifier: MIT
// What impulses are worth, the bound of energy that follows from it, and the guards on it.
#include "step/merit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cairn/detail/eigen.h"
#include "cairn/solver.h"
#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using test::Scene;
using test::Solution;

/// Contacts, pins and motors between moving bodies, with targets on some rows.
Scene MovingPile(std::uint64_t seed) {
  Scene scene = test::RandomPile({.bodies = 12, .contacts = 25, .pins = 4}, seed);
  test::Random random(seed);
  for (Row& row : scene.rows) {
    if (row.parent == kNoRow) row.target = random.Uniform(-20, 20);
  }
  return scene;
}

double KineticEnergy(const Scene& scene, const std::vector<Velocity>& v) {
  double energy = 0;
  for (size_t i = 0; i < v.size(); ++i) {
    const Body& body = scene.bodies[i];
    const Eigen::Vector3d momentum = View(v[i].linear) / body.inv_mass;
    energy += momentum.dot(View(v[i].linear)) / 2;
    energy += View(v[i].angular).dot(View(body.inv_inertia).inverse() * View(v[i].angular)) / 2;
  }
  return energy;
}

Settings SweepsOn(Path path, int sweeps) {
  Settings settings = test::PlainSweeps(sweeps);
  settings.method = Method::kPgsSm;
  settings.k_sm = 0;
  settings.path = path;
  return settings;
}

constexpr Path kPaths[] = {Path::kReference, Path::kFast};

TEST(Merit, IsTheEnergyAfterTheStepLessWhatTargetsPutIn) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene scene = MovingPile(seed);
    const Solution none = test::Solve(test::PlainSweeps(0), scene);
    const Solution s = test::Solve(test::PlainSweeps(7), scene);
    double targets = 0;
    for (size_t i = 0; i < s.x.size(); ++i) {
      targets += scene.rows[i].target * s.x[i] - scene.rows[i].compliance * s.x[i] * s.x[i] / 2;
    }
    double merit = 0;
    for (const IslandReport& island : Measure(scene.problem(), s.x).islands) merit += island.merit;
    const double gained = KineticEnergy(scene, s.v) - KineticEnergy(scene, none.v);
    // rounding of sums of 100 products
    EXPECT_NEAR(merit, gained - targets, 1e-11 * KineticEnergy(scene, none.v));
  }
}

TEST(Merit, OfSweepsFromNoneIsNeverAboveNone) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene scene = MovingPile(seed);
    for (const int sweeps : {1, 2, 5, 40}) {
      for (const Path path : kPaths) {
        const Report report = test::Solve(SweepsOn(path, sweeps), scene).report;
        EXPECT_EQ(report.guarded, 0);
        for (const IslandReport& island : report.islands) EXPECT_LE(island.merit, 0);
      }
    }
  }
}

TEST(Merit, OfBlocksIsThatOfDoubles) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene scene = MovingPile(seed);
    const Solution s = test::Solve(SweepsOn(Path::kFast, 10), scene);
    const Report measured = Measure(scene.problem(), s.x);
    ASSERT_EQ(s.report.islands.size(), measured.islands.size());
    for (size_t i = 0; i < measured.islands.size(); ++i) {
      // sums of floats
      EXPECT_NEAR(s.report.islands[i].merit, measured.islands[i].merit,
                  1e-4 * std::abs(measured.islands[i].merit));
    }
  }
}

/// The most that targets can put into the island at rest, with bounds of friction as @p x has them:
/// the largest t'y - 1/2 y'(A + E) y inside the bounds.
double EnergyOfTargets(Scene scene, const std::vector<double>& x) {
  for (Body& body : scene.bodies) {
    body.velocity = {};
    View(body.impulse).setZero();
    View(body.angular_impulse).setZero();
  }
  for (Row& row : scene.rows) {
    if (row.parent == kNoRow) continue;
    row.hi = row.friction * std::max(0.0, x[row.parent]);
    row.lo = -row.hi;
    row.parent = kNoRow;
    row.friction = 0;
  }
  double energy = 0;
  const Solution rest = test::Solve(test::PlainSweeps(20000), scene);
  for (const IslandReport& island : Measure(scene.problem(), rest.x).islands) {
    energy -= island.merit;
  }
  return energy;
}

double Largest(const std::vector<double>& x) { return *std::max_element(x.begin(), x.end()); }

// docs/solver.md: |v|_M <= |v_free|_M + 2 sqrt(2 e_t) for every x that is not worse than none.
TEST(Merit, BoundsTheEnergyFromTheProblemAlone) {
  int tight = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Scene scene = MovingPile(seed);
    const double before =
        std::sqrt(2 * KineticEnergy(scene, test::Solve(test::PlainSweeps(0), scene).v));
    for (const int sweeps : {1, 3, 30}) {
      const Solution s = test::Solve(test::PlainSweeps(sweeps), scene);
      const double after = std::sqrt(2 * KineticEnergy(scene, s.v));
      const double targets = EnergyOfTargets(scene, s.x);
      EXPECT_LE(after, before + 2 * std::sqrt(2 * targets));
      if (after > before) ++tight;
    }
  }
  EXPECT_GT(tight, 0) << "no target put in anything, so nothing was tested";
}

TEST(StepTrial, IsWonByWhatIsLessRoughOrSurelyCloser) {
  const auto alone_is_better = [](double with_step, double alone, double lead, bool begins = false,
                                  bool strained = false) {
    return StepTrial{with_step, alone, lead, begins, strained}.is_better_alone();
  };
  EXPECT_FALSE(alone_is_better(0.1, 0.2, -1)) << "where phi cannot tell";
  EXPECT_TRUE(alone_is_better(0.2, 0.1, -1));
  EXPECT_FALSE(alone_is_better(0.2, 0.1, 0.01)) << "closer, and not much rougher";
  EXPECT_TRUE(alone_is_better(0.5, 0.1, 0.01));
  // a bridge that falls as a whole: 1.1 J ahead, of which what is rough takes back 0.02 at most
  EXPECT_FALSE(alone_is_better(0.14, 0.03, 1.1, true));
  EXPECT_TRUE(alone_is_better(0.14, 0.03, 1.1, false)) << "joints that contradict each other?";
  EXPECT_TRUE(alone_is_better(0.14, 0.03, 0.1, true));
  EXPECT_FALSE(alone_is_better(0.14, 0.03, 1.1, false, true));
  // a bridge at rest that a step throws: a little less rough, and far behind
  EXPECT_TRUE(alone_is_better(7e-4, 1e-3, -7.6, true));
  EXPECT_FALSE(alone_is_better(7e-4, 1e-3, -1e-6, true));
  EXPECT_FALSE(alone_is_better(7e-4, 1e-3, -7.6, false, true));
  EXPECT_TRUE(alone_is_better(std::nan(""), 0.1, 1));
  EXPECT_TRUE(alone_is_better(0.2, 0.1, std::nan("")));
}

TEST(IsFaster, IsWhatHasMoreSpeedOrEnergyOrSpin) {
  const IslandMotion before{.speed = 2, .energy = 10};
  EXPECT_FALSE(IsFaster(before, 1, {.speed = 2.4, .energy = 11}, 2));
  EXPECT_TRUE(IsFaster(before, 1, {.speed = 2.6, .energy = 5}, 1)) << "one of many bodies";
  EXPECT_TRUE(IsFaster(before, 1, {.speed = 2, .energy = 14}, 0));
  EXPECT_TRUE(IsFaster(before, 1, {.speed = 2, .energy = 10}, 4));
  EXPECT_TRUE(IsFaster(before, 1, {.speed = std::nan(""), .energy = 10}, 1));
}

TEST(Guards, ScaleAStartThatIsWorseThanNone) {
  const Scene scene = test::Tower(6);
  const std::vector<double> good = test::Solve(test::PlainSweeps(200), scene).x;
  std::vector<double> rotten = good;
  for (double& x : rotten) x *= 1000;
  for (const Path path : kPaths) {
    const Solution kept = test::Solve(SweepsOn(path, 3), scene, good);
    EXPECT_FALSE(kept.report.islands[0].guards.start);
    const Solution cold = test::Solve(SweepsOn(path, 3), scene);
    const Solution guarded = test::Solve(SweepsOn(path, 3), scene, rotten);
    EXPECT_TRUE(guarded.report.islands[0].guards.start);
    EXPECT_EQ(guarded.report.guarded, 1);
    // scaled by a thousandth, it is the good start again
    EXPECT_LT(guarded.report.islands[0].merit, cold.report.islands[0].merit);
  }
}

// Where a point of contact is replaced by another, what it carried is lost: the rest of the start
// is worth less than none, though one sweep mends it.
TEST(Guards, KeepAStartThatLostAPointOfContact) {
  const Scene scene = test::Tower(20);
  std::vector<double> start = test::Solve(test::PlainSweeps(3000), scene).x;
  for (size_t i = 0; i < start.size(); ++i) {
    if (scene.rows[i].parent != kNoRow || start[i] < 0.3 * Largest(start)) continue;
    start[i] = 0;
    break;
  }
  EXPECT_GT(Measure(scene.problem(), start).islands[0].merit, 0);
  for (const Path path : kPaths) {
    const Solution s = test::Solve(SweepsOn(path, 10), scene, start);
    EXPECT_FALSE(s.report.islands[0].guards.any());
    const Solution cold = test::Solve(SweepsOn(path, 10), scene);
    EXPECT_LT(s.report.islands[0].merit, 2 * cold.report.islands[0].merit);
  }
}

// Sweeps would smooth it before it is seen.
TEST(Guards, ScaleAStartOfJointsAfterOneSweep) {
  const Scene scene = test::HangingChain(6, 10);
  std::vector<double> rotten = test::Solve(test::PlainSweeps(200), scene).x;
  for (double& x : rotten) x *= 1000;
  for (const Path path : kPaths) {
    EXPECT_TRUE(test::Solve(SweepsOn(path, 1), scene, rotten).report.islands[0].guards.start);
  }
  const Scene tower = test::Tower(6);
  rotten = test::Solve(test::PlainSweeps(200), tower).x;
  for (double& x : rotten) x *= 1000;
  for (const Path path : kPaths) {
    EXPECT_FALSE(test::Solve(SweepsOn(path, 2), tower, rotten).report.islands[0].guards.start);
  }
}

TEST(Guards, LeaveAStartAloneThatNobodySweeps) {
  const Scene scene = test::Tower(2);
  std::vector<double> rotten(scene.rows.size(), 0.0);
  for (size_t i = 0; i < rotten.size(); ++i) rotten[i] = scene.rows[i].parent == kNoRow ? 100 : 0;
  for (const Path path : kPaths) {
    const Solution s = test::Solve(SweepsOn(path, 0), scene, rotten);
    EXPECT_EQ(s.x, rotten);
    EXPECT_EQ(s.report.guarded, 0);
  }
}

// Islands that sweeps leave unfinished begin with a part of their impulses.
TEST(Start, IsNotSoftenedWhereARowCannotBeNone) {
  Scene scene = test::HangingChain(6, 10);
  Row drive = test::PointRow(scene, 3, kWorld, {0, 0, 0}, Eigen::Vector3d::UnitX());
  drive.lo = 1;
  drive.hi = 2;
  drive.host.max_sweeps = 0;
  scene.rows.push_back(drive);
  Settings settings;
  settings.path = Path::kFast;
  settings.max_sweeps = 2;
  Solver solver(settings);
  std::vector<double> x;
  for (int frame = 0; frame < 3; ++frame) {
    const Solution s = test::Solve(&solver, scene, x);
    EXPECT_EQ(s.report.stop, StopReason::kSweepLimit);
    EXPECT_EQ(s.x.back(), 1);
    const double measured = Measure(scene.problem(), s.x).residual_energy;
    EXPECT_NEAR(s.report.residual_energy, measured, 1e-4 * measured) << frame;
    x = s.x;
  }
}

/// Boxes on two pins each, in a row; the pins of a box contradict each other by so much [m/s].
Scene ContradictoryBridge(int boxes, double contradiction) {
  Scene scene;
  for (int i = 0; i < boxes; ++i) {
    scene.bodies.push_back(test::Box(1, {1, 0.2, 2}));
    scene.bodies.back().impulse = {0, -test::kGravityStep, 0};
    scene.positions.push_back({static_cast<double>(i), 0, 0});
  }
  for (int i = 0; i <= boxes; ++i) {
    for (const double side : {-0.9, 0.9}) {
      const size_t first = scene.rows.size();
      const int a = i > 0 ? i - 1 : kWorld, b = i < boxes ? i : kWorld;
      test::AddPin(&scene, a, b, {i - 0.5, 0, side});
      scene.rows[first + 2].target = side * contradiction;
    }
  }
  return scene;
}

double LargestImpulse(const Solution& s) {
  double largest = 0;
  for (const double x : s.x) largest = std::max(largest, std::abs(x));
  return largest;
}

// Pins of a box push against each other; what they do not agree on grew from frame to frame until
// floats could not hold it.
TEST(Guards, KeepImpulsesOfRedundantJointsWhereFloatsCanHoldThem) {
  const Scene scene = ContradictoryBridge(10, 0.1);
  for (const Path path : kPaths) {
    Settings settings = test::AlwaysSteps(10);
    settings.path = path;
    Solver solver(settings);
    Solution s;
    double first = 0, last = 0;
    for (int frame = 0; frame < 200; ++frame) {
      s = test::Solve(&solver, scene, s.x);
      ASSERT_TRUE(s.report.ok());
      if (frame == 20) first = LargestImpulse(s);
      if (frame >= 20) last = std::max(last, LargestImpulse(s));
    }
    EXPECT_LT(last, 1e5);
    EXPECT_LE(last, 20 * first);
  }
}

// With next to nothing to soften them, pins that contradict each other by 1 m/s push with 1e12 m/s.
TEST(Guards, UndoAStepThatLeavesImpulsesThatFloatsCannotHold) {
  const Scene scene = ContradictoryBridge(4, 1);
  for (const Path path : kPaths) {
    Settings settings = test::AlwaysSteps(10);
    settings.path = path;
    settings.proximal_joints = 1e-12;
    const Solution s = test::Solve(settings, scene);
    ASSERT_TRUE(s.report.ok());
    EXPECT_TRUE(s.report.islands[0].guards.step);
    EXPECT_EQ(s.report.guarded, 1);
    EXPECT_EQ(s.report.steps_accepted, 0);
    EXPECT_EQ(s.report.steps_restored, 1);
    EXPECT_LT(LargestImpulse(s), 1e3);
    EXPECT_LE(s.report.islands[0].merit, 0);
  }
}

/// A box on two pins so far apart [m] that move apart at 0.1 m/s.
Scene TurnedByItsPins(double apart) {
  Scene scene;
  scene.bodies.push_back(test::Box(1, {1, 0.2, 2}));
  scene.positions.push_back({0, 0, 0});
  for (const double side : {-0.5, 0.5}) {
    const size_t first = scene.rows.size();
    test::AddPin(&scene, kWorld, 0, {0, 0, side * apart});
    scene.rows[first].target = 0.1 * side;
  }
  return scene;
}

// Over an arm of 1 cm, 0.1 m/s are 10 rad/s, which sweeps would not come to in hundreds of frames.
TEST(Guards, UndoAStepThatThrowsABody) {
  for (const Path path : kPaths) {
    Settings settings = test::AlwaysSteps(10);
    settings.path = path;
    const Solution thrown = test::Solve(settings, TurnedByItsPins(0.01));
    ASSERT_TRUE(thrown.report.ok());
    EXPECT_TRUE(thrown.report.islands[0].guards.step);
    EXPECT_EQ(thrown.report.steps_restored, 1);
    EXPECT_LT(View(thrown.v[0].angular).norm(), 1);

    const Solution turned = test::Solve(settings, TurnedByItsPins(0.5));
    EXPECT_FALSE(turned.report.islands[0].guards.step);
    EXPECT_EQ(turned.report.steps_accepted, 1);
    EXPECT_NEAR(View(turned.v[0].angular).norm(), 0.2, 0.01);
  }
}

/// A tower of four boxes under a plate that comes down by so much [m/s].
Scene TowerUnderAPress(double speed) {
  Scene scene = test::Tower(4);
  for (const auto& [x, y] : {std::pair(-0.5, -0.5), {-0.5, 0.5}, {0.5, -0.5}, {0.5, 0.5}}) {
    const Eigen::Vector3d point(x, y, 4);
    Row normal = test::PointRow(scene, 3, kWorld, point, -Eigen::Vector3d::UnitZ());
    normal.target = speed;
    test::AddContact(&scene, normal, point, 0.5);
  }
  return scene;
}

// Ground and plate cannot both have what they ask for: a step gives them impulses that grow until
// what softens them says no.
TEST(Guards, UndoAStepThatOnlySqueezes) {
  for (const Path path : kPaths) {
    Settings settings = test::AlwaysSteps(10);
    settings.path = path;
    const Scene pressed = TowerUnderAPress(1);
    const Solution s = test::Solve(settings, pressed);
    ASSERT_TRUE(s.report.ok());
    EXPECT_TRUE(s.report.islands[0].guards.step);
    EXPECT_EQ(s.report.steps_accepted, 0);
    settings.k_sm = 0;
    EXPECT_LE(LargestImpulse(s), 2 * LargestImpulse(test::Solve(settings, pressed)));

    settings.k_sm = 1;
    const Solution follows = test::Solve(settings, TowerUnderAPress(-0.05));
    EXPECT_FALSE(follows.report.islands[0].guards.step) << "there is room";
    EXPECT_EQ(follows.report.steps_accepted, 1);
  }
}

// Friction of 20 times a pile's, over-relaxed and cut as its normals shrink, from a random start:
// there even sweeps end worse than they began, on a few in a hundred.
TEST(Guards, ScaleAResultThatIsWorseThanNone) {
  for (const Path path : kPaths) {
    int guarded = 0;
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
      Scene scene = test::RandomPile({.bodies = 5, .contacts = 12, .world_share = 0.3}, seed);
      test::Random random(seed);
      std::vector<double> start(scene.rows.size());
      for (size_t i = 0; i < start.size(); ++i) {
        scene.rows[i].relaxation = random.Uniform(1, 1.99);
        scene.rows[i].friction *= 20;
        start[i] = random.Uniform(-1, 1);
      }
      const Solution s = test::Solve(SweepsOn(path, 4), scene, start);
      ASSERT_TRUE(s.report.ok());
      for (const IslandReport& island : s.report.islands) {
        guarded += island.guards.result ? 1 : 0;
        // rounding of floats apart
        EXPECT_LE(island.merit, 1e-5) << seed;
      }
    }
    EXPECT_GT(guarded, 0);
  }
}

TEST(Guards, TakeNothingFromALoadedChain) {
  // 3,000 m/s are what impulses of a chain with 10,000 times a link come to
  const Scene scene = test::HangingChain(30, 1e4);
  for (const Path path : kPaths) {
    Settings settings = test::AlwaysSteps(10);
    settings.path = path;
    Solver solver(settings);
    Solution s;
    for (int frame = 0; frame < 20; ++frame) {
      s = test::Solve(&solver, scene, s.x);
      EXPECT_EQ(s.report.guarded, 0);
    }
    EXPECT_LT(s.report.residual_max, 1e-2);
  }
}

}  // namespace
}  // namespace cairn
