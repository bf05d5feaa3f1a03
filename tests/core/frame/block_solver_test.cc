// SPDX-License-Identifier: MIT
// The block path as a whole: what it computes, that islands do not see each other, and that bad
// input leaves no trace.
#include "cycle/block_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "cairn/detail/eigen.h"
#include "plan/plan.h"
#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using test::Coloured;
using test::Scene;
using test::Solution;

/// The same sweeps in double precision, in the units of the caller, pair by pair of a Plan.
class Oracle {
 public:
  Oracle(const Scene& scene, const Settings& settings, const std::vector<double>& start)
      : scene_(scene), settings_(settings), x_(start) {
    x_.resize(scene.rows.size());
    parts_.assign(scene.bodies.size(), 1);
    for (const Body& body : scene.bodies) {
      v_.push_back(body.velocity);
      Push(body, body.impulse, body.angular_impulse, &v_.back());
    }
    for (size_t i = 0; i < x_.size(); ++i) {
      x_[i] = Project(static_cast<int>(i), x_[i]);
      Apply(scene.rows[i], x_[i]);
    }
    omega_ = settings.method == Method::kPsor ? settings.tuning.omega : 1;
    test::MakePlan(scene, omega_, &plan_);
  }

  void Sweep(int number) {
    for (const simd::LaneRun& run : plan_.runs()) {
      const std::vector<Velocity> before = v_;
      std::vector<Velocity> after = v_;
      for (int lane = run.first; lane < run.first + run.lanes; ++lane) {
        const Pair& pair = plan_.pair(run.block, lane);
        const simd::PairBlock& block = plan_.blocks()[run.block];
        See(pair.a, block.a[lane]);
        See(pair.b, block.b[lane]);
        for (int row : plan_.rows_of(pair)) {
          if (number < scene_.rows[row].host.max_sweeps) Relax(row);
        }
        for (const int body : {pair.a, pair.b}) {
          if (body == kWorld) continue;
          Add(parts_[body], v_[body], before[body], &after[body]);
          v_[body] = before[body];
          parts_[body] = 1;
        }
      }
      v_ = after;
    }
  }
  const std::vector<double>& x() const { return x_; }
  const std::vector<Velocity>& v() const { return v_; }

 private:
  /// A lane sees a part of a body that others have the rest of.
  void See(int body, int slot) {
    const simd::BodyCopy* const copy = plan_.copy_at(slot);
    if (copy != nullptr) parts_[body] = static_cast<double>(copy->share) * copy->share;
  }
  /// What the part moved by is a part of what the body moves by.
  static void Add(double part, const Velocity& now, const Velocity& before, Velocity* sum) {
    View(sum->linear) += part * (View(now.linear) - View(before.linear));
    View(sum->angular) += part * (View(now.angular) - View(before.angular));
  }
  static void Push(const Body& body, const Vector3d& push, const Vector3d& turn, Velocity* v) {
    View(v->linear) += body.inv_mass * View(body.linear_factor).cwiseProduct(push);
    View(v->angular) += View(body.inv_inertia) * turn;
  }
  void Apply(const Row& row, double x) {
    for (const auto& [body, linear, angular] :
         {std::tuple(row.body_a, row.linear_a, row.angular_a),
          std::tuple(row.body_b, row.linear_b, row.angular_b)}) {
      if (body == kWorld) continue;
      const double impulse = x / parts_[body];
      Push(scene_.bodies[body], impulse * View(linear), impulse * View(angular), &v_[body]);
    }
  }
  double Project(int index, double x) const {
    const Row& row = scene_.rows[index];
    double lo = row.lo, hi = row.hi;
    if (row.parent != kNoRow) {
      lo = std::max(lo, -row.friction * std::max(0.0, x_[row.parent]));
      hi = std::min(hi, row.friction * std::max(0.0, x_[row.parent]));
    }
    return std::min(std::max(x, lo), hi);
  }
  void Relax(int index) {
    const Row& row = scene_.rows[index];
    double d = row.compliance, w = row.compliance * x_[index] - row.target;
    double locked = 0;
    for (const auto& [body, linear, angular] :
         {std::tuple(row.body_a, row.linear_a, row.angular_a),
          std::tuple(row.body_b, row.linear_b, row.angular_b)}) {
      if (body == kWorld) continue;
      const Body& b = scene_.bodies[body];
      const double part = parts_[body];
      d += View(linear).dot(b.inv_mass * View(b.linear_factor).cwiseProduct(View(linear))) / part;
      d += View(angular).dot(View(b.inv_inertia) * View(angular)) / part;
      locked += test::DeniedByLocks(b, linear) / part;
      w += View(linear).dot(View(v_[body].linear)) + View(angular).dot(View(v_[body].angular));
    }
    const bool held = settings_.tuning.lifted_friction == detail::LiftedFriction::kHold &&
                      row.parent != kNoRow && x_[row.parent] <= 0;
    if (held) return;
    // what nothing can satisfy asks for nothing, and stays inside its bounds
    const double step = d > 0 ? omega_ * row.relaxation * w / (d + locked) : 0;
    const double x = Project(index, x_[index] - step);
    Apply(row, x - x_[index]);
    x_[index] = x;
  }

  const Scene& scene_;
  const Settings settings_;
  double omega_ = 1;
  Plan plan_;
  std::vector<double> x_;
  std::vector<Velocity> v_;
  std::vector<double> parts_;  ///< of the mass of each body, that the lane at hand sees
};

double Largest(const std::vector<double>& x) {
  return test::Distance(x, std::vector<double>(x.size()));
}

/// Every relaxation rounds to 2^-24 of the largest number that it sees, and the sweeps after it
/// pass that on without making it larger, as they contract. A body sees some 20 rows a sweep: 20
/// sweeps are sqrt(400) such roundings where they are independent, and kShare leaves five
/// times that.
constexpr double kShare = 6e-6;

/// How far impulses and velocities are from the oracle's, as shares of the largest impulse.
double DistanceToOracle(const Scene& scene, const Settings& settings,
                        const std::vector<double>& start = {}) {
  Oracle oracle(scene, settings, start);
  for (int sweep = 0; sweep < settings.max_sweeps; ++sweep) oracle.Sweep(sweep);
  const Solution s = test::Solve(settings, scene, start);
  EXPECT_TRUE(s.report.ok());
  EXPECT_EQ(s.report.sweeps, settings.max_sweeps);
  const double scale = std::max(1.0, Largest(oracle.x()));
  return std::max(test::Distance(s.x, oracle.x()), test::Distance(s.v, oracle.v())) / scale;
}

void ExpectLikeTheOracle(const Scene& scene, const Settings& settings,
                         const std::vector<double>& start = {}, double share = kShare) {
  EXPECT_LT(DistanceToOracle(scene, settings, start), share);
}

/// Sweeps on blocks that never stop before they are told to, and do not choose among iterates.
TEST(BlockSolver, SweepsAsTheOracleDoesInTheOrderOfThePlan) {
  for (int sweeps : {1, 5, 20}) {
    SCOPED_TRACE(sweeps);
    ExpectLikeTheOracle(test::Tower(15), Coloured(sweeps));
    ExpectLikeTheOracle(test::NormalsFirst(test::Wall(6, 5)), Coloured(sweeps));
    ExpectLikeTheOracle(test::HangingChain(20, 10), Coloured(sweeps));
    ExpectLikeTheOracle(test::Plate(100), Coloured(sweeps));
    // where impulses of friction change sides, what was rounded grows: in 3 heaps of 60 to 1e-4
    std::vector<double> distances;
    for (std::uint64_t seed = 1; seed <= 21; ++seed) {
      const Scene heap = test::Heap({.bodies = 40, .contacts = 90, .pins = 10}, seed);
      distances.push_back(DistanceToOracle(heap, Coloured(sweeps)));
    }
    std::sort(distances.begin(), distances.end());
    EXPECT_LT(distances[10], kShare / 10);
    EXPECT_LT(distances[17], kShare);
  }
}

Scene EveryLaw(std::uint64_t seed) {
  Scene scene = test::Heap({.bodies = 40, .contacts = 90, .pins = 10}, seed);
  scene.bodies[2].linear_factor = {1, 0, 0.5};
  scene.bodies[4] = Body{};
  scene.bodies[5].inv_mass = 0;
  return test::WithEveryLaw(scene, seed);
}

std::vector<double> RandomStart(const Scene& scene, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<double> start(scene.rows.size());
  for (double& x : start) x = random.Uniform(-0.3, 1);
  return start;
}

TEST(BlockSolver, ObeysEveryLawOfARowAsTheOracleDoes) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = EveryLaw(seed);
    for (const auto lifted : {detail::LiftedFriction::kRelease, detail::LiftedFriction::kHold}) {
      Settings settings = Coloured(8);
      settings.tuning.lifted_friction = lifted;
      ExpectLikeTheOracle(scene, settings);
      ExpectLikeTheOracle(scene, settings, RandomStart(scene, seed));
    }
    Settings settings = Coloured(8);
    settings.method = Method::kPsor;
    settings.tuning.omega = 1.2;
    ExpectLikeTheOracle(scene, settings, RandomStart(scene, seed), 1e-5);
  }
}

// Two bodies meet in 13 000 points: more rows than a lane can number the parents of.
TEST(BlockSolver, SolvesAPairOfVeryManyRows) {
  Scene scene;
  scene.bodies.push_back(test::Box(1, {1, 1, 1}));
  scene.bodies[0].impulse.z() = -test::kGravityStep;
  scene.positions.emplace_back(0, 0, 0.5);
  test::Random random(1);
  for (int i = 0; i < 13000; ++i) {
    const Vector3d point(random.Uniform(-0.5, 0.5), random.Uniform(-0.5, 0.5), 0);
    test::AddContact(&scene, test::PointRow(scene, 0, kWorld, point, Vector3d::UnitZ()), point,
                     0.5);
  }
  const Solution s = test::Solve(Coloured(3), scene);
  ASSERT_TRUE(s.report.ok());
  // all in one pair: the order of the problem, and 39 000 roundings
  const Solution reference = test::Solve(test::PlainSweeps(3), scene);
  EXPECT_LT(test::Distance(s.x, reference.x), 1e-4);
  EXPECT_LT(test::Distance(s.v, reference.v), 1e-4);
}

/// A tower in which bodies change between two frames of one solver.
void ExpectFollows(const std::function<void(std::vector<Body>*)>& change) {
  Scene scene = test::Tower(4);
  Solver steady(Coloured(8));
  (void)test::Solve(&steady, scene);
  change(&scene.bodies);
  const Solution s = test::Solve(&steady, scene);
  for (const Velocity& v : s.v)
    EXPECT_TRUE(View(v.linear).allFinite() && View(v.angular).allFinite());
  Oracle oracle(scene, Coloured(8), {});
  for (int sweep = 0; sweep < 8; ++sweep) oracle.Sweep(sweep);
  EXPECT_LT(test::Distance(s.x, oracle.x()), 6e-6);
  EXPECT_LT(test::Distance(s.v, oracle.v()), 6e-6);
}

TEST(BlockSolver, FollowsAMassThatChanges) {
  ExpectFollows([](std::vector<Body>* bodies) { (*bodies)[1].inv_mass = 0.25; });
  ExpectFollows([](std::vector<Body>* bodies) { (*bodies)[1].inv_mass = 0; });
  ExpectFollows([](std::vector<Body>* bodies) { (*bodies)[1] = Body{}; });
}

// They still turn. The form that contacts are swept in divides by the sum of both inverse masses.
TEST(BlockSolver, FollowsTwoBodiesThatLoseTheirMass) {
  ExpectFollows([](std::vector<Body>* bodies) {
    (*bodies)[1].inv_mass = 0;
    (*bodies)[2].inv_mass = 0;
  });
}

// The same form has one mass for all axes.
TEST(BlockSolver, FollowsAnAxisThatIsLocked) {
  ExpectFollows([](std::vector<Body>* bodies) { (*bodies)[1].linear_factor = {0, 1, 1}; });
  ExpectFollows([](std::vector<Body>* bodies) { (*bodies)[1].linear_factor = {1, 1, 0.5}; });
}

/// Each part alone gives what it gives beside the others.
void ExpectIslandsAlone(const std::vector<Scene>& parts, const Settings& settings) {
  const Solution together = test::Solve(settings, test::Together(parts));
  ASSERT_TRUE(together.report.ok());
  size_t rows = 0, bodies = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    SCOPED_TRACE("part " + std::to_string(i));
    const Solution alone = test::Solve(settings, parts[i]);
    const auto x = together.x.begin() + static_cast<std::ptrdiff_t>(rows);
    const auto v = together.v.begin() + static_cast<std::ptrdiff_t>(bodies);
    rows += parts[i].rows.size();
    bodies += parts[i].bodies.size();
    Solution part;
    part.x.assign(x, x + static_cast<std::ptrdiff_t>(parts[i].rows.size()));
    part.v.assign(v, v + static_cast<std::ptrdiff_t>(parts[i].bodies.size()));
    EXPECT_TRUE(test::SameBits(alone, part));
  }
}

std::vector<Scene> Islands() {
  std::vector<Scene> parts = {
      test::Tower(2),  test::HangingChain(8, 5), test::Wall(3, 4),         test::Wall(12, 13),
      test::Tower(12), test::HangingChain(3, 1), test::HangingChain(2, 50)};
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    parts.push_back(test::Heap({.bodies = 9, .contacts = 20, .pins = 3}, seed));
  }
  return parts;
}

TEST(Islands, SolvedTogetherHaveTheBitsOfEachAlone) {
  ExpectIslandsAlone(Islands(), Coloured(30));
  ExpectIslandsAlone(Islands(), test::ColouredSteps(30));
}

// Towers of different heights are done at different times; lanes that they share go on.
TEST(Islands, ThatHaveConvergedDoNotChangeWhileOthersGoOn) {
  for (Settings settings : {Coloured(300), test::ColouredSteps(100)}) {
    settings.tolerance = 1e-3;
    ExpectIslandsAlone(Islands(), settings);
    const Solution s = test::Solve(settings, test::Together(Islands()));
    std::vector<int> sweeps;
    for (const IslandReport& island : s.report.islands) sweeps.push_back(island.sweeps);
    std::sort(sweeps.begin(), sweeps.end());
    EXPECT_LT(sweeps.front(), sweeps.back());
    EXPECT_EQ(s.report.islands[0].stop, StopReason::kConverged);
  }
}

/// A hub under more boxes than there are colours, of two shapes that come in a given order, so that
/// the order of pairs without a colour matters.
Scene Hub(int boxes, int first_points) {
  Scene scene;
  scene.bodies.push_back(test::Box(50, {20, 20, 1}));
  scene.positions.emplace_back(0, 0, 0.5);
  test::Random random(4);
  for (int i = 1; i <= boxes; ++i) {
    scene.bodies.push_back(test::Box(1, {1, 1, 1}));
    scene.bodies.back().impulse.z() = -random.Uniform(0.1, 0.3);
    const Vector3d at(random.Uniform(-9, 9), random.Uniform(-9, 9), 1.5);
    scene.positions.push_back(at);
    const int points = i % 2 == 1 ? first_points : 3 - first_points;
    for (int k = 0; k < points; ++k) {
      const Vector3d point = at + Vector3d(0.3 * k, 0.2, -0.5);
      test::AddContact(&scene, test::PointRow(scene, i, 0, point, Vector3d::UnitZ()), point, 0.5);
    }
  }
  return scene;
}

TEST(BlockSolver, SweepsAsTheOracleDoesWhereLanesShareAHub) {
  for (const int sweeps : {1, 5, 20}) {
    SCOPED_TRACE(sweeps);
    ExpectLikeTheOracle(Hub(60, 1), Coloured(sweeps));
    ExpectLikeTheOracle(Hub(300, 2), Coloured(sweeps));
    ExpectLikeTheOracle(Hub(60, 2), Coloured(sweeps), RandomStart(Hub(60, 2), 3));
  }
}

/// A light plate on which heavy boxes are pinned all around, and thrown in all directions.
Scene PinnedHub(int boxes) {
  Scene scene;
  scene.bodies.push_back(test::Box(1, {20, 20, 1}));
  scene.positions.emplace_back(0, 0, 0);
  test::Random random(9);
  for (int i = 1; i <= boxes; ++i) {
    scene.bodies.push_back(test::Box(10, {1, 1, 1}));
    scene.bodies.back().impulse = random.Vector(10);
    const Vector3d at(random.Uniform(-9, 9), random.Uniform(-9, 9), 1);
    scene.positions.push_back(at);
    test::AddPin(&scene, i, 0, at - Vector3d(0, 0, 0.5));
  }
  return scene;
}

// Joints alone are a linear system, which a step solves at once if it sees the whole hub.
TEST(BlockSolver, AStepSolvesWhatSharesAHub) {
  const Scene hub = PinnedHub(60);
  Settings steps = test::ColouredSteps(200), sweeps = Coloured(200);
  steps.tolerance = sweeps.tolerance = 1e-3;
  const Solution by_steps = test::Solve(steps, hub), by_sweeps = test::Solve(sweeps, hub);
  EXPECT_GT(by_steps.report.steps_accepted, 0);
  EXPECT_LT(by_steps.report.residual_max, 1e-3);
  EXPECT_LE(by_steps.report.sweeps, 3 * steps.k_gs);
  EXPECT_GT(by_sweeps.report.sweeps, 10 * steps.k_gs);
}

// Shapes are numbered as they come, and pairs without a colour are sorted by them.
TEST(Islands, WithPairsBeyondAllColoursHaveTheBitsOfEachAloneToo) {
  ExpectIslandsAlone({Hub(60, 1), Hub(60, 2)}, Coloured(10));
}

/// Two hubs and boxes on either, in no order: pairs without a colour fill each other's lanes.
Scene TwinHubs(std::uint64_t seed) {
  test::Random random(seed);
  Scene scene;
  for (int hub = 0; hub < 2; ++hub) scene.bodies.push_back(test::PointMass(20));
  for (int i = 0; i < 90; ++i) {
    scene.bodies.push_back(test::PointMass(1, {0, 0, -random.Uniform(0.1, 0.3)}));
    scene.rows.push_back(test::PushRow(2 + i, random.Index(2), random.Direction()));
  }
  for (int i = 0; i < 30; ++i) {
    scene.rows.push_back(test::PushRow(2 + random.Index(90), random.Index(2), random.Direction()));
  }
  return scene;
}

TEST(Islands, WithTwoCrowdedBodiesHaveTheBitsOfEachAloneToo) {
  std::vector<Scene> parts;
  for (std::uint64_t seed = 1; seed <= 9; ++seed) parts.push_back(TwinHubs(seed));
  ExpectIslandsAlone(parts, Coloured(10));
  // some bodies are only seen as copies, and steps go back to where they were
  ExpectIslandsAlone(parts, test::ColouredSteps(40));
}

}  // namespace
}  // namespace cairn
