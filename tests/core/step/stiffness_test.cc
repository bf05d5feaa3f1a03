// SPDX-License-Identifier: MIT
#include "cairn/detail/stiffness.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
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

constexpr double kStep = 1.0 / 60;  // [s]

/// Solves it and has the stiffness learn from that.
Solution SolveAndLearn(const Scene& scene, GeometricStiffness* stiffness,
                       Settings settings = test::AlwaysSteps(30)) {
  Solution s = test::Solve(settings, scene);
  EXPECT_TRUE(s.report.ok());
  stiffness->Learn(kStep, scene.problem(), {.rows = s.x}, s.report);
  return s;
}

std::vector<Body> Raised(const Scene& scene, GeometricStiffness* stiffness) {
  std::vector<Body> bodies = scene.bodies;
  stiffness->RaiseInertia(kStep, bodies);
  return bodies;
}

TEST(Stiffness, RaisesALoadedLinkAsFarAsItsTensionAsks) {
  // links of 1 kg and 1 m along z: above and below, joints pull T at 0.5 m each, so that K = T * 1
  // m about both axes across it, and nothing about its own
  const double load = 1000;
  const Scene scene = test::HangingChain(3, load);
  GeometricStiffness stiffness;
  SolveAndLearn(scene, &stiffness);
  const std::vector<Body> raised = Raised(scene, &stiffness);
  const Eigen::Vector3d before = View(scene.bodies[0].inv_inertia).diagonal();
  const Eigen::Vector3d after = View(raised[0].inv_inertia).diagonal();
  // it carries the load, the link below it, and half of itself on average
  const double tension = (load + 1 + 0.5) * test::kGravityStep / kStep;
  int across = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double s = kStep * kStep * tension * before[axis];
    if (axis == 2) {
      EXPECT_NEAR(after[axis], before[axis], 1e-6 * before[axis]) << "its own axis";
      continue;
    }
    ASSERT_GT(s, 4) << "not a hard case";
    EXPECT_NEAR(before[axis] / after[axis], 1 + (s - 2), 0.01 * s);
    ++across;
  }
  EXPECT_EQ(across, 2);
}

TEST(Stiffness, LeavesWhatPullsLittleAsItIsToTheBit) {
  const Scene scene = test::HangingChain(5, 1);
  GeometricStiffness stiffness;
  SolveAndLearn(scene, &stiffness);
  std::vector<Body> bodies = scene.bodies;
  EXPECT_TRUE(stiffness.RaiseInertia(kStep, bodies).empty());
  for (size_t i = 0; i < bodies.size(); ++i) {
    EXPECT_EQ(bodies[i].inv_inertia, scene.bodies[i].inv_inertia);
  }
}

// Engines leave out bodies that sleep, or leave them where they are and take their mass away.
TEST(Stiffness, IsKeptOfWhatSleeps) {
  Scene awake = test::HangingChain(3, 1000);
  for (size_t i = 0; i < awake.bodies.size(); ++i) awake.bodies[i].id = 7 + i;
  Scene others = test::HangingChain(1, 1);
  others.bodies[0].id = 99;
  Scene still = awake;
  still.rows.clear();
  for (Body& body : still.bodies) body.inv_mass = 0, body.inv_inertia = {};
  for (const Scene& meanwhile : {others, still}) {
    GeometricStiffness stiffness;
    SolveAndLearn(awake, &stiffness);
    const double strain = Raised(awake, &stiffness)[0].strain;
    ASSERT_GT(strain, 2);
    for (int frame = 0; frame < 100; ++frame) {
      Raised(meanwhile, &stiffness);
      SolveAndLearn(meanwhile, &stiffness);
    }
    EXPECT_NEAR(Raised(awake, &stiffness)[0].strain, strain, 1e-9 * strain);
  }
}

TEST(Stiffness, KnowsNothingOfContacts) {
  const Scene scene = test::Tower(10);
  GeometricStiffness stiffness;
  SolveAndLearn(scene, &stiffness);
  std::vector<Body> bodies = scene.bodies;
  EXPECT_TRUE(stiffness.RaiseInertia(kStep, bodies).empty());
}

TEST(Stiffness, LeavesBodiesWithoutJointsAlone) {
  GeometricStiffness stiffness;
  const Scene loaded = test::HangingChain(3, 1000);
  SolveAndLearn(loaded, &stiffness);
  ASSERT_FALSE(stiffness.empty());
  // at once, where that is known before
  std::vector<Body> bodies = loaded.bodies;
  const std::vector<char> jointed(bodies.size(), 0);
  EXPECT_TRUE(stiffness.RaiseInertia(kStep, bodies, jointed).empty());
  // and after a step without joints
  Scene cut = loaded;
  cut.rows.clear();
  SolveAndLearn(cut, &stiffness);
  EXPECT_TRUE(stiffness.empty());
}

/// Share of its momentum about x, as a solver sees it, that a link has from a spin [rad/s] before.
double MomentumOf(double spin, const GeometricStiffness::Raised& raised, const Matrix3& before,
                  const Matrix3& after) {
  const double change = raised.Damp(kStep, {spin, 0, 0}).x();
  return (spin + change) / spin * before(0, 0) / after(0, 0);
}

// Spin that a body has when its inertia rises keeps the momentum it had. While the inertia stays
// raised, slow spin keeps nearly all of what it has then, and fast spin is left with what the body
// has without: so what stops a body is never thrown by weight it was lent.
TEST(Stiffness, LendsSpinNoMomentum) {
  const Scene scene = test::HangingChain(3, 1000);
  GeometricStiffness stiffness;
  SolveAndLearn(scene, &stiffness);
  const Matrix3 whole = scene.bodies[0].inv_inertia;
  constexpr double kSlow = 0.1, kFast = 1 / kStep;  // [rad/s]: a rad in a step
  for (const bool rises : {true, false}) {
    std::vector<Body> bodies = scene.bodies;
    const auto raised = stiffness.RaiseInertia(kStep, bodies);
    ASSERT_FALSE(raised.empty());
    ASSERT_EQ(raised[0].body, 0);
    const Matrix3 after = bodies[0].inv_inertia;
    const double lent = whole(0, 0) / after(0, 0);
    ASSERT_GT(lent, 20);
    const double slow = MomentumOf(kSlow, raised[0], whole, after),
                 fast = MomentumOf(kFast, raised[0], whole, after);
    if (rises) {
      EXPECT_LT(slow, 1 + 1e-9);
      EXPECT_GT(slow, 0.97);
      EXPECT_LT(fast, 1 + 1e-9);
    } else {
      EXPECT_LT(slow, 0.981 * lent);
      EXPECT_GT(slow, 0.97 * lent);
      EXPECT_NEAR(fast, 1, 1e-9);
    }
    // about its own axis nothing is raised
    const Vector3 along = raised[0].Damp(kStep, {0, 0, kFast});
    EXPECT_NEAR(View(along).norm(), 0, 1e-9 * kFast);
  }
}

TEST(Stiffness, FadesWhenTheLoadIsGone) {
  GeometricStiffness stiffness;
  const Scene loaded = test::HangingChain(3, 100), free = test::HangingChain(3, 1);
  SolveAndLearn(loaded, &stiffness);
  double last = Raised(loaded, &stiffness)[0].inv_inertia(0, 0);
  const double whole = loaded.bodies[0].inv_inertia(0, 0);
  ASSERT_LT(last, whole / 2);
  int steps = 0;
  for (; last < whole && steps < 200; ++steps) {
    SolveAndLearn(free, &stiffness);
    const double now = Raised(free, &stiffness)[0].inv_inertia(0, 0);
    EXPECT_GE(now, last);
    EXPECT_LE(whole / now - 1, 0.9 * (whole / last + 1)) << "held by 0.9 of what was needed";
    last = now;
  }
  EXPECT_EQ(last, whole);
  EXPECT_LT(steps, 60);
}

TEST(Stiffness, MistakesNobodyForSomebodyElse) {
  Scene scene = test::HangingChain(3, 100);
  for (size_t i = 0; i < scene.bodies.size(); ++i) scene.bodies[i].id = i + 1;
  GeometricStiffness stiffness;
  SolveAndLearn(scene, &stiffness);
  Scene other = scene;
  for (Body& body : other.bodies) body.inv_mass *= 2;  // others, that got their ids
  EXPECT_EQ(Raised(other, &stiffness)[0].inv_inertia, other.bodies[0].inv_inertia);
  EXPECT_NE(Raised(scene, &stiffness)[0].inv_inertia, scene.bodies[0].inv_inertia);
  stiffness.Reset();
  EXPECT_EQ(Raised(scene, &stiffness)[0].inv_inertia, scene.bodies[0].inv_inertia);
}

TEST(Stiffness, AveragesWhatSweepsAloneLeave) {
  const Scene scene = test::HangingChain(3, 100);
  GeometricStiffness once, often;
  SolveAndLearn(scene, &once);
  Settings sweeps = test::PlainSweeps(2000);
  // the first of them counts by a tenth
  SolveAndLearn(scene, &often, sweeps);
  EXPECT_GT(Raised(scene, &often)[0].inv_inertia(0, 0),
            2 * Raised(scene, &once)[0].inv_inertia(0, 0));
  for (int i = 0; i < 100; ++i) SolveAndLearn(scene, &often, sweeps);
  EXPECT_NEAR(Raised(scene, &often)[0].inv_inertia(0, 0), Raised(scene, &once)[0].inv_inertia(0, 0),
              0.01);
}

TEST(Stiffness, DampsTheSpinOfRaisedAxesALittle) {
  Scene scene = test::HangingChain(3, 1e4);
  GeometricStiffness stiffness;
  SolveAndLearn(scene, &stiffness);
  Raised(scene, &stiffness);  // as it rises spin keeps its momentum: from the next step on
  for (Body& body : scene.bodies) body.velocity.angular = {0.1, 0.1, 1};
  stiffness.Apply(kStep, scene.bodies);
  EXPECT_NEAR(scene.bodies[0].velocity.angular.x() / 0.1, 0.98, 0.001);
  EXPECT_NEAR(scene.bodies[0].velocity.angular.z(), 1, 1e-6);
}

TEST(Stiffness, TakesBodiesThatCannotMoveForWhatTheyAre) {
  // the chain hangs from a lift
  Scene scene = test::HangingChain(3, 1000);
  scene.bodies.push_back({});
  for (int i = 0; i < 3; ++i) scene.rows[i].body_b = 3;
  GeometricStiffness stiffness;
  SolveAndLearn(scene, &stiffness);
  const std::vector<Body> raised = Raised(scene, &stiffness);
  EXPECT_LT(raised[0].inv_inertia(0, 0), scene.bodies[0].inv_inertia(0, 0) / 2);
  EXPECT_EQ(raised[3].inv_inertia, scene.bodies[3].inv_inertia);
}

// Nothing outside takes up what raised inertia keeps of an impulse.
TEST(Stiffness, LeavesIslandsAloneThatNothingHolds) {
  Scene scene = test::HangingChain(3, 1000);
  scene.rows.erase(scene.rows.begin(), scene.rows.begin() + 3);  // the pin to the world
  for (Body& body : scene.bodies) View(body.impulse).setZero();
  scene.bodies[0].impulse.z() = 1000;  // and yet it is under tension
  GeometricStiffness stiffness;
  const Solution s = SolveAndLearn(scene, &stiffness);
  EXPECT_GT(std::abs(s.x[2]), 100);
  std::vector<Body> bodies = scene.bodies;
  EXPECT_TRUE(stiffness.RaiseInertia(kStep, bodies).empty());
}

TEST(Stiffness, SaysHowMuchItStrains) {
  const Scene scene = test::HangingChain(3, 1000);
  GeometricStiffness stiffness;
  SolveAndLearn(scene, &stiffness);
  const std::vector<Body> whole = Raised(scene, &stiffness);
  // as in the first test
  const double tension = (1000 + 1 + 0.5) * test::kGravityStep / kStep;
  const double moment = scene.bodies[0].inv_inertia(0, 0);  // across the chain
  EXPECT_NEAR(whole[0].strain, kStep * kStep * tension * moment, 0.01 * whole[0].strain);
  GeometricStiffness again;
  SolveAndLearn(scene, &again);
  std::vector<Body> half = scene.bodies;
  again.RaiseInertia(kStep / 2, half);
  EXPECT_NEAR(half[0].strain, whole[0].strain / 4, 1e-9 * whole[0].strain);

  GeometricStiffness calm;
  SolveAndLearn(test::HangingChain(3, 1), &calm);
  EXPECT_LT(Raised(test::HangingChain(3, 1), &calm)[0].strain, 2);
}

void Bound(double lo, double hi, Scene* scene) {
  for (Row& row : scene->rows) row.lo = lo, row.hi = hi;
}

// Three links are so few that a step would take longer than all else, and heavy loads tear them:
// before they strain, too. All have one in their first frame.
TEST(Stiffness, HasStepsTakenWhereItStrainsOrHoldsALoad) {
  const auto steps = [](double strain, double lo, double hi, double load = 50) {
    Scene scene = test::HangingChain(3, load);
    Bound(lo, hi, &scene);
    for (Body& body : scene.bodies) body.strain = strain;
    Settings settings{.max_sweeps = 10, .tolerance = 1e-4, .step_policy = StepPolicy::kWeighed};
    Solver solver(settings);
    int taken = 0;
    for (int frame = 0; frame < 20; ++frame)
      taken += test::Solve(&solver, scene).report.steps_accepted;
    return taken;
  };
  EXPECT_LE(steps(0, -kInfinity, kInfinity), 1);
  EXPECT_GT(steps(3, -kInfinity, kInfinity), 10);
  EXPECT_GT(steps(3, -1e6, 1e6), 10) << "as motors";
  EXPECT_GT(steps(3, -1e6, kInfinity), 10) << "as limits";
  EXPECT_GT(steps(0, -kInfinity, kInfinity, 200), 10) << "with a load";
}

TEST(Stiffness, CountsWhatMayBreakAndNoLimits) {
  const auto moment = [](double lo, double hi) {
    Scene scene = test::HangingChain(3, 1000);
    Bound(lo, hi, &scene);
    GeometricStiffness stiffness;
    SolveAndLearn(scene, &stiffness, test::AlwaysSteps(3000));
    return 1 / Raised(scene, &stiffness)[0].inv_inertia(0, 0);
  };
  const double light = 1 / test::HangingChain(3, 1000).bodies[0].inv_inertia(0, 0);
  const double raised = moment(-kInfinity, kInfinity);
  EXPECT_GT(raised, 2 * light);
  EXPECT_NEAR(moment(-1e6, 1e6), raised, 0.01 * raised);
  EXPECT_EQ(moment(-1e6, kInfinity), light);
}

TEST(Stiffness, LearnsNothingFromWhatWasRefused) {
  Scene scene = test::HangingChain(3, 100);
  GeometricStiffness stiffness;
  Report refused;
  refused.status = Status::kNotFinite;
  std::vector<double> x(scene.rows.size(), 100.0);
  stiffness.Learn(kStep, scene.problem(), {.rows = x}, refused);
  Report other;  // of another problem: it names no islands
  stiffness.Learn(kStep, scene.problem(), {.rows = x}, other);
  EXPECT_EQ(Raised(scene, &stiffness)[0].inv_inertia, scene.bodies[0].inv_inertia);
}

/// A link that hangs from the world, and a load that hangs from it by a joint whose second body is
/// the link.
struct LoadedLink {
  std::vector<Body> bodies = {test::Box(1, {0.1, 0.1, 1}), test::Box(1000, {1, 1, 1})};
  std::vector<Joint> joints = {{.body_a = 0, .rows = 3},
                               {.body_a = 1, .body_b = 0, .first_row = 3, .rows = 3}};
  std::vector<JointRow> rows = std::vector<JointRow>(6);

  LoadedLink() {
    const Eigen::Vector3d up(0, 0, 0.5);
    const auto put = [](const Eigen::Vector3d& from, float* to) {
      for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(from[i]);
    };
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
      put(axis, rows[k].linear_a);
      put(up.cross(axis), rows[k].angular_a);
      put(axis, rows[3 + k].linear_a);
      put(up.cross(axis), rows[3 + k].angular_a);
      put(-axis, rows[3 + k].linear_b);
      put(up.cross(axis), rows[3 + k].angular_b);
    }
    for (Body& body : bodies) body.impulse = {0, 0, -test::kGravityStep / body.inv_mass};
  }

  /// Of the link, after a step.
  Eigen::Matrix3d RaisedInverse() const {
    const ContactProblem problem{.bodies = bodies, .joints = joints, .joint_rows = rows};
    std::vector<float> impulses(rows.size());
    std::vector<Velocity> velocities(2);
    Solver solver(test::AlwaysSteps(30));
    const Report report = solver.Solve(problem, {.joint_rows = impulses}, velocities);
    EXPECT_TRUE(report.ok()) << Describe(report);
    GeometricStiffness stiffness;
    stiffness.Learn(kStep, problem, {.joint_rows = impulses}, report);
    std::vector<Body> raised = bodies;
    stiffness.RaiseInertia(kStep, raised);
    return raised[0].inv_inertia;
  }
};

TEST(Stiffness, DoesNotReadWhatOppositeRowsDoNotSay) {
  LoadedLink link;
  const Eigen::Matrix3d said = link.RaisedInverse();
  ASSERT_LT(said(0, 0), link.bodies[0].inv_inertia(0, 0) / 2) << "not a hard case";
  link.joints[1].opposite = true;
  EXPECT_EQ(link.RaisedInverse(), said);
  for (int k = 3; k < 6; ++k) std::fill_n(link.rows[k].linear_b, 3, 0.0f);
  EXPECT_EQ(link.RaisedInverse(), said);
}

// As joints of games in a plane have them: the row across it moves nobody.
TEST(Stiffness, TakesTwoRowsForAPullWhereBodiesCannotMoveAcrossThem) {
  LoadedLink three;
  for (Body& body : three.bodies) {
    body.linear_factor = {1, 0, 1};
    body.inv_inertia(0, 0) = body.inv_inertia(2, 2) = 0;
  }
  LoadedLink two = three;
  two.rows = {three.rows[0], three.rows[2], three.rows[3], three.rows[5]};
  two.joints[0].rows = two.joints[1].rows = two.joints[1].first_row = 2;
  const double raised = three.RaisedInverse()(1, 1);
  ASSERT_LT(raised, three.bodies[0].inv_inertia(1, 1) / 2) << "not a hard case";
  EXPECT_NEAR(two.RaisedInverse()(1, 1), raised, 1e-4 * raised);
  for (Body& body : two.bodies) body.linear_factor = {1, 1, 1};
  EXPECT_EQ(two.RaisedInverse()(1, 1), three.bodies[0].inv_inertia(1, 1)) << "a slider's";
}

TEST(Stiffness, ForgetsTheStrainOfWhatNothingPulls) {
  GeometricStiffness stiffness;
  std::vector<Body> bodies = test::HangingChain(3, 1).bodies;
  bodies[1].strain = 17;
  stiffness.RaiseInertia(kStep, bodies);
  EXPECT_EQ(bodies[1].strain, 0);
}

}  // namespace
}  // namespace cairn
