// SPDX-License-Identifier: MIT
// Heavy loads on light jointed bodies in a small engine: Settings::geometric_stiffness.
#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <cstring>
#include <functional>
#include <utility>
#include <vector>

#include "cairn/detail/stiffness.h"
#include "tests/core/engine/small_world.h"

namespace cairn {
namespace {

using test::SmallWorld;
using test::Thing;
using test::Vector3d;

constexpr double kGravity = 9.81;
const Vector3d kTop(0, 0.5, 0), kBottom(0, -0.5, 0);

/// Links of 1 kg and 1 m that hang from the origin, and a load at their end, at the same distance.
struct Chain {
  int links;
  double load;
  SmallWorld world;
  int cut = -1;        ///< the joint above this thing is gone, and of kAll all are
  JointKind top = {};  ///< of the joint to the world
  bool sleeps = false;
  static constexpr int kAll = -2;

  Chain(int links_, double load_, Settings settings, double tilt = 0.2)
      : links(links_), load(load_), top(BallJoint()) {
    settings.tolerance = 1e-5;
    settings.max_sweeps = 30;
    world.solver = Solver(settings);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(tilt, Vector3d::UnitZ()));
    Vector3d pin(0, 0, 0);
    for (int i = 0; i <= links; ++i) {
      Thing thing;
      thing.turn = turn;
      thing.position = pin + turn * kBottom;
      thing.inertia = 0.1;
      if (i == links) thing.mass = load, thing.inertia = 0.4 * load;
      world.things.push_back(thing);
      pin = thing.position + turn * kBottom;
    }
  }
  void Step() {
    std::vector<double> masses;
    for (Thing& thing : world.things) {
      masses.push_back(thing.mass);
      if (sleeps) thing.mass = 0, thing.velocity = {};
    }
    world.Step([this](SmallWorld* w) {
      for (int i = 0; i <= links && !sleeps; ++i) {
        if (i == cut || cut == kAll) continue;
        const JointSide above = i == 0 ? JointSide{} : w->things[i - 1].Side(i - 1, kBottom);
        w->joints.Add(i == 0 ? top : BallJoint(), w->things[i].Side(i, kTop), above,
                      static_cast<std::uint64_t>(i + 1));
      }
    });
    for (size_t i = 0; i < masses.size(); ++i) world.things[i].mass = masses[i];
  }
  /// Largest of so many steps.
  double GapOf(int steps) {
    double gap = 0;
    for (int i = 0; i < steps; ++i) {
      Step();
      gap = std::max(gap, world.joints.worst_gap().largest);
    }
    return gap;
  }
  double MostStrain() const {
    double most = 0;
    for (const IslandReport& island : world.report.islands) most = std::max(most, island.strain);
    return most;
  }
};

testing::AssertionResult SameBits(const SmallWorld& a, const SmallWorld& b) {
  if (a.things.size() != b.things.size()) return testing::AssertionFailure() << "not as many";
  for (size_t i = 0; i < a.things.size(); ++i) {
    const Thing &x = a.things[i], &y = b.things[i];
    if (x.position != y.position || x.turn.coeffs() != y.turn.coeffs() ||
        x.velocity.linear != y.velocity.linear || x.velocity.angular != y.velocity.angular) {
      return testing::AssertionFailure() << "thing " << i;
    }
  }
  return testing::AssertionSuccess();
}

TEST(Tension, HoldsLoadsThatTearChainsWithout) {
  Chain on(6, 1000, {}), off(6, 1000, {.geometric_stiffness = false});
  EXPECT_LT(on.GapOf(240), 0.02);
  EXPECT_GT(off.GapOf(240), 1);
  EXPECT_GT(on.MostStrain(), 4) << "not a hard case";
}

TEST(Tension, ActsInDoublePrecisionAndWithSubstepsToo) {
  for (Settings settings : {Settings{.path = Path::kReference, .step_policy = StepPolicy::kAlways},
                            Settings{.substeps = 2}, Settings{.relax = true}}) {
    Chain on(6, 1000, settings);
    settings.geometric_stiffness = false;
    Chain off(6, 1000, settings);
    const double gap = on.GapOf(240);
    EXPECT_LT(gap, 0.02) << settings.substeps << settings.relax;
    EXPECT_GT(off.GapOf(240), 10 * gap) << settings.substeps << settings.relax;
  }
}

TEST(Tension, ChangesNoBitWhereNothingIsStrained) {
  // the load pulls with s = h^2 T / I = 0.4 at most
  Chain on(6, 10, {}, 0.02), off(6, 10, {.geometric_stiffness = false}, 0.02);
  for (int step = 0; step < 200; ++step) {
    on.Step();
    off.Step();
    ASSERT_TRUE(SameBits(on.world, off.world)) << step;
  }
  EXPECT_GT(on.MostStrain(), 0.1) << "looked at";
  EXPECT_LT(on.MostStrain(), 2) << "not strained";
  EXPECT_EQ(off.MostStrain(), 0);
}

/// The first step of a chain again and again: how its links turn, and what the report says.
struct FirstStep {
  Chain chain;
  std::vector<ContactMotion> motions;
  double time_step = 1 / 60.0;

  explicit FirstStep(const Settings& settings) : chain(3, 1000, settings) {}

  std::vector<Body> Bodies() const {
    std::vector<Body> bodies;
    for (const Thing& thing : chain.world.things) {
      Body& body = bodies.emplace_back();
      body.id = bodies.size();
      body.velocity = thing.velocity;
      body.inv_mass = 1 / thing.mass;
      body.inv_inertia = Eigen::Matrix3d::Identity() / thing.inertia;
      body.impulse = Vector3d(0, -kGravity / 60 * thing.mass, 0);
    }
    return bodies;
  }
  /// @p stiffness: learns from it
  std::vector<Velocity> Solve(const std::vector<Body>& bodies, GeometricStiffness* stiffness) {
    const StepInput step{.bodies = bodies};
    Contacts contacts;
    Joints joints;
    contacts.Begin(step);
    joints.Begin(step);
    for (int i = 0; i <= 3; ++i) {
      joints.Add(BallJoint(), chain.world.things[i].Side(i, kTop),
                 i == 0 ? JointSide{} : chain.world.things[i - 1].Side(i - 1, kBottom), 0);
    }
    ContactProblem problem = ProblemOf(step, contacts, joints);
    problem.time_step = time_step;
    problem.motions = motions;
    const Impulses impulses = StartOf(&contacts, &joints);
    std::vector<Velocity> velocities(bodies.size());
    Report& report = chain.world.report;
    report = chain.world.solver.Solve(problem, impulses, velocities);
    EXPECT_TRUE(report.ok()) << Describe(report);
    if (stiffness != nullptr) stiffness->Learn(1 / 60.0, problem, impulses, report);
    return velocities;
  }
};

TEST(Tension, NeedsTheLengthOfTheStepAndAllMotionInTheBodies) {
  for (const int kind : {0, 1, 2}) {
    FirstStep on({}), off({.geometric_stiffness = false});
    for (FirstStep* of : {&on, &off}) {
      if (kind == 1) of->time_step = 0;
      if (kind < 2) continue;
      ContactMotion falls;
      falls.free_velocity[1] = static_cast<float>(-kGravity / 60);
      of->motions.assign(4, falls);
    }
    bool same = true;
    for (int i = 0; i < 5; ++i) {
      const auto a = on.Solve(on.Bodies(), nullptr), b = off.Solve(off.Bodies(), nullptr);
      for (size_t k = 0; k < a.size(); ++k) same = same && a[k].angular == b[k].angular;
    }
    EXPECT_EQ(same, kind > 0);
    EXPECT_EQ(on.chain.MostStrain() > 0, kind == 0);
  }
}

// The joint to the world carries 1,006 kg at rest, to the percent, in every step.
TEST(Tension, LeavesWhatJointsExertAtTheWeight) {
  Chain chain(6, 1000, {}, 0);
  for (int step = 0; step < 300; ++step) {
    chain.Step();
    if (step < 60) continue;
    const std::span<const float> impulse = chain.world.joints.impulses_of(0);
    const double force = Vector3d(impulse[0], impulse[1], impulse[2]).norm() * 60;
    ASSERT_NEAR(force, 1006 * kGravity, 0.01 * 1006 * kGravity) << step;
  }
  EXPECT_GT(chain.MostStrain(), 4) << "not a hard case";
}

TEST(Tension, LetsGoAtOnceWhereAJointBreaks) {
  Chain chain(6, 1000, {});
  EXPECT_LT(chain.GapOf(120), 0.02);
  chain.cut = 6;  // the load falls
  const double before = chain.world.things[6].velocity.linear[1];
  for (int i = 1; i <= 30; ++i) {
    chain.Step();
    const Vector3d spin = View(chain.world.things[6].velocity.angular);
    EXPECT_NEAR(chain.world.things[6].velocity.linear[1], before - kGravity * i / 60, 1e-6);
    EXPECT_LT(spin.norm(), 20);
  }
  EXPECT_LT(chain.GapOf(200), 0.05);
  EXPECT_LT(chain.MostStrain(), 2) << "of links that carry themselves";
}

// Nothing turns it any more, and nothing damps it.
TEST(Tension, LeavesWhatLostAllJointsAloneInTheSameStep) {
  Chain chain(2, 1000, {});
  for (int i = 0; i < 60; ++i) chain.Step();
  ASSERT_GT(chain.MostStrain(), 4) << "not a hard case";
  const Vector3 spin = chain.world.things[0].velocity.angular;
  ASSERT_GT(View(spin).norm(), 0.01);
  chain.cut = Chain::kAll;
  chain.Step();
  EXPECT_EQ(chain.world.things[0].velocity.angular, spin);
}

// Strain goes with the square of the step, and is that of the parts of it.
TEST(Tension, IsThatOfTheParts) {
  Chain once(6, 1000, {}, 0), parts(6, 1000, {.substeps = 3}, 0);
  for (int i = 0; i < 60; ++i) {
    once.Step();
    parts.Step();
  }
  EXPECT_NEAR(parts.MostStrain(), once.MostStrain() / 9, 0.05 * parts.MostStrain());
}

TEST(Tension, HoldsLoadsThatWakeUp) {
  Chain chain(6, 1000, {}, 0.1);
  EXPECT_LT(chain.GapOf(120), 0.02);
  chain.sleeps = true;
  for (int i = 0; i < 30; ++i) chain.Step();
  EXPECT_TRUE(chain.world.report.islands.empty());
  chain.sleeps = false;
  EXPECT_LT(chain.GapOf(240), 0.02);
}

TEST(Tension, HoldsWhatMotorsLiftAndTurn) {
  // a motor about the chain, and one across it that lifts it by a quarter of a turn
  Settings off;
  off.geometric_stiffness = false;
  for (const Vector3d& about : {Vector3d::UnitY().eval(), Vector3d::UnitZ().eval()}) {
    double gaps[2];
    for (int i = 0; i < 2; ++i) {
      Chain chain(4, 1000, i == 0 ? Settings{} : off, 0.05);
      JointKind motor = BallJoint();
      motor.twist.speed = 0.3;
      motor.twist.max_motor_force = 2e5;
      chain.top = motor;
      SmallWorld& world = chain.world;
      double gap = 0;
      for (int step = 0; step < 240; ++step) {
        world.Step([&](SmallWorld* w) {
          const Eigen::Matrix3d axes =
              Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitX(), about).toRotationMatrix();
          JointSide side = w->things[0].Side(0, kTop), fixed;
          side.axes = w->things[0].turn.toRotationMatrix() * axes;
          fixed.axes = axes;
          w->joints.Add(motor, side, fixed, 1);
          for (int link = 1; link <= 4; ++link) {
            w->joints.Add(BallJoint(), w->things[link].Side(link, kTop),
                          w->things[link - 1].Side(link - 1, kBottom),
                          static_cast<std::uint64_t>(link + 1));
          }
        });
        gap = std::max(gap, world.joints.worst_gap().largest);
      }
      gaps[i] = gap;
    }
    EXPECT_LT(gaps[0], 0.1);
    EXPECT_LT(gaps[0], gaps[1] / 4) << "not a hard case";
  }
}

TEST(Tension, StaysWithinABudgetOfWork) {
  for (const std::int64_t units : {200, 1000, 5000}) {
    Chain on(6, 1000, {.budget = Budget::Work(units)});
    Chain off(6, 1000, {.geometric_stiffness = false, .budget = Budget::Work(units)});
    const double gap = on.GapOf(240);
    // 200 units are ten sweeps, and no step
    EXPECT_LT(gap, units < 1000 ? 1 : 0.1) << units;
    EXPECT_GT(off.GapOf(240), 1.5 * gap) << units;
  }
}

/// Share of a gap of 2 cm at its top that a hanging chain takes back in a step, over the usual.
double ShareTakenBack(Chain* chain) {
  for (int step = 0; step < 60; ++step) chain->Step();
  for (Thing& thing : chain->world.things) thing.position.y() -= 0.02;
  const double before = -(chain->world.things[0].position + kTop).y();
  chain->Step();
  const double after = -(chain->world.things[0].position + kTop).y();
  return (before - after) / (0.2 * before);
}

TEST(Tension, TakesGapsBackMoreSlowlyWhereItStrains) {
  Chain light(3, 10, {}, 0), heavy(3, 3000, {}, 0), off(3, 3000, {.geometric_stiffness = false}, 0);
  EXPECT_NEAR(ShareTakenBack(&light), 1, 0.01);
  const double share = ShareTakenBack(&heavy);
  EXPECT_GT(heavy.MostStrain(), 32) << "not a hard case";
  EXPECT_NEAR(share, ShareOfErp(heavy.MostStrain()), 0.02);
  EXPECT_LT(share, 0.5);
  EXPECT_NEAR(ShareTakenBack(&off), 1, 0.01);
  // the report tells what the gap asks for, and what was done of it
  EXPECT_NEAR(heavy.world.report.gap.done, share * heavy.world.report.gap.asked, 0.002);
}

TEST(Tension, LeavesTheSpeedOfMotorsAlone) {
  // the load hangs on an axis that a motor lowers it along
  Chain chain(3, 3000, {}, 0);
  for (int step = 0; step < 60; ++step) chain.Step();
  ASSERT_GT(chain.MostStrain(), 32) << "not a hard case";
  chain.top.linear[1] = {.speed = 0.25, .max_motor_force = 1e6};
  const double before = chain.world.things[0].position.y();
  chain.Step();
  EXPECT_NEAR(std::abs(chain.world.things[0].position.y() - before) * 60, 0.25, 0.01);
}

// An engine that raised inertia itself before there was a setting keeps its results, and strains.
TEST(Tension, IsNotAppliedTwice) {
  FirstStep with({}), without({.geometric_stiffness = false});
  GeometricStiffness stiffness;
  double strain = 0;
  for (int step = 0; step < 20; ++step) {
    std::vector<Body> bodies = without.Bodies();
    stiffness.Apply(1 / 60.0, bodies);
    const auto a = with.Solve(bodies, nullptr), b = without.Solve(bodies, &stiffness);
    for (size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(a[i].angular, b[i].angular) << step;
      without.chain.world.things[i].velocity = b[i];
    }
    ASSERT_EQ(with.chain.MostStrain(), without.chain.MostStrain()) << step;
    strain = std::max(strain, with.chain.MostStrain());
  }
  EXPECT_GT(strain, 4) << "not a hard case";
}

#ifdef __GLIBC__
// As debug builds of engines do. Lanes of a factor that no body is in divide by zero.
TEST(Tension, StepsOfAnEngineThatTrapsInvalidNumbersTrapNothing) {
  Chain chain(6, 1000, {.step_policy = StepPolicy::kAlways});
  int accepted = 0;
  const int before = feenableexcept(FE_INVALID | FE_DIVBYZERO);
  for (int step = 0; step < 30; ++step) {
    chain.Step();
    accepted += chain.world.report.steps_accepted;
  }
  fedisableexcept(FE_ALL_EXCEPT);
  feenableexcept(before);
  EXPECT_GT(accepted, 0);
}
#endif

TEST(Tension, IsForgottenOnResetAndWhereItIsOff) {
  Chain chain(6, 1000, {}, 0);
  const auto strain_of_a_step = [&chain] {
    chain.Step();
    return chain.MostStrain();
  };
  for (int i = 0; i < 5; ++i) chain.Step();
  EXPECT_GT(chain.MostStrain(), 4);
  chain.world.solver.Reset();
  EXPECT_EQ(strain_of_a_step(), 0);
  EXPECT_GT(strain_of_a_step(), 4);
  chain.world.solver.settings().geometric_stiffness = false;
  EXPECT_EQ(strain_of_a_step(), 0);
  chain.world.solver.settings().geometric_stiffness = true;
  EXPECT_EQ(strain_of_a_step(), 0) << "nothing is known of the step before";
}

// What is refused is refused as ever, also while tension is remembered.
TEST(Tension, LooksAtNoBodyThatIsNotThere) {
  Chain chain(3, 1000, {}, 0);
  for (int i = 0; i < 3; ++i) chain.Step();
  Body bodies[3] = {};
  for (int i = 0; i < 3; ++i) {
    bodies[i].id = static_cast<std::uint64_t>(i + 1);
    bodies[i].inv_mass = 1;
  }
  JointRow row{.linear_a = {0, 1, 0}};
  float impulse = 0;
  std::vector<Velocity> velocities(3);
  for (const int body : {3, 1 << 20, -7}) {
    const Joint joint{.body_a = body};
    const ContactProblem problem{
        .bodies = bodies, .joints = {&joint, 1}, .joint_rows = {&row, 1}, .time_step = 1 / 60.0};
    const Report report =
        chain.world.solver.Solve(problem, {.joint_rows = {&impulse, 1}}, velocities);
    EXPECT_EQ(report.status, Status::kNoSuchBody);
  }
}

}  // namespace
}  // namespace cairn
