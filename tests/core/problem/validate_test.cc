// SPDX-License-Identifier: MIT
// Input that is refused: the right status, the right offender, and not one bit written.
#include "problem/validate.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>

#include "cairn/detail/eigen.h"
#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using test::Scene;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// A NaN that no computation makes.
constexpr std::uint64_t kPattern = 0x7ff80000deadbeefULL;

double PatternValue() {
  double value;
  std::memcpy(&value, &kPattern, sizeof(value));
  return value;
}

/// The results of a refused Solve(): impulses as given, velocities filled with the pattern.
Report SolveUntouched(Solver* solver, const Scene& scene, const std::vector<double>& start) {
  const double p = PatternValue();
  const Velocity unwritten{.linear = {p, p, p}, .angular = {p, p, p}};
  std::vector<double> impulses = start;
  std::vector<Velocity> velocities(scene.bodies.size(), unwritten);
  const std::vector<Velocity> velocities_before = velocities;

  const Report report = solver->Solve(scene.problem(), impulses, velocities);

  EXPECT_FALSE(report.ok());
  EXPECT_EQ(std::memcmp(impulses.data(), start.data(), start.size() * sizeof(double)), 0);
  EXPECT_EQ(std::memcmp(velocities.data(), velocities_before.data(),
                        velocities.size() * sizeof(Velocity)),
            0);
  EXPECT_EQ(report.stop, StopReason::kNotStarted);
  EXPECT_EQ(report.work, 0);
  EXPECT_TRUE(report.islands.empty());
  return report;
}

/// Three bodies in a line; rows 2 and 3 are friction of row 1.
Scene GoodScene() {
  Scene scene;
  for (int i = 0; i < 3; ++i) {
    scene.bodies.push_back(test::Box(1, {1, 1, 1}));
    scene.positions.emplace_back(i, 0, 0);
  }
  scene.rows.push_back(test::PushRow(0, kWorld, {0, 0, 1}));
  test::AddContact(&scene, test::PointRow(scene, 1, 0, {0.5, 0, 0}, {1, 0, 0}), {0.5, 0, 0}, 0.5);
  scene.rows.push_back(test::PushRow(2, 1, {1, 0, 0}));
  return scene;
}

struct Refused {
  std::string what;
  Status status;
  std::function<void(Scene*)> spoil;
};

void ExpectRefused(const Refused& refused, int bad_row, int bad_body) {
  SCOPED_TRACE(refused.what);
  Scene scene = GoodScene();
  refused.spoil(&scene);
  const std::vector<double> start(scene.rows.size(), 0.25);
  Solver solver;
  for (const Report& report :
       {SolveUntouched(&solver, scene, start), Measure(scene.problem(), start)}) {
    EXPECT_EQ(report.status, refused.status) << Describe(report.status);
    EXPECT_EQ(report.bad_row, bad_row);
    EXPECT_EQ(report.bad_body, bad_body);
    // an inertia that is not definite has no single number to blame
    if (refused.status == Status::kBadMass) continue;
    ASSERT_NE(report.bad_setting.name, nullptr);
    if (refused.status == Status::kNotFinite) {
      EXPECT_EQ(report.bad_setting.name, refused.what);
    }
  }
}

TEST(Validate, AcceptsTheSceneThatTheOtherTestsSpoil) {
  EXPECT_TRUE(test::Solve(Settings{}, GoodScene()).report.ok());
}

TEST(Validate, RefusesWhatIsNotFiniteInEveryNumberOfABody) {
  const std::vector<std::pair<std::string, std::function<double*(Body*)>>> fields = {
      {"inv_mass", [](Body* b) { return &b->inv_mass; }},
      {"inv_inertia", [](Body* b) { return &b->inv_inertia(2, 1); }},
      {"linear_factor", [](Body* b) { return &b->linear_factor.y(); }},
      {"velocity.linear", [](Body* b) { return &b->velocity.linear.z(); }},
      {"velocity.angular", [](Body* b) { return &b->velocity.angular.x(); }},
      {"impulse", [](Body* b) { return &b->impulse.y(); }},
      {"angular_impulse", [](Body* b) { return &b->angular_impulse.z(); }},
  };
  for (const auto& [name, number] : fields) {
    const auto& field = number;  // clang 14 captures no bindings
    for (double bad : {kNan, kInfinity, -kInfinity}) {
      ExpectRefused({name, Status::kNotFinite, [&](Scene* s) { *field(&s->bodies[1]) = bad; }}, -1,
                    1);
    }
  }
}

TEST(Validate, RefusesWhatIsNotFiniteInEveryNumberOfARow) {
  const std::vector<std::pair<std::string, std::function<double*(Row*)>>> fields = {
      {"linear_a", [](Row* r) { return &r->linear_a.x(); }},
      {"angular_a", [](Row* r) { return &r->angular_a.y(); }},
      {"linear_b", [](Row* r) { return &r->linear_b.z(); }},
      {"angular_b", [](Row* r) { return &r->angular_b.x(); }},
      {"target", [](Row* r) { return &r->target; }},
      {"compliance", [](Row* r) { return &r->compliance; }},
      {"relaxation", [](Row* r) { return &r->relaxation; }},
      {"friction", [](Row* r) { return &r->friction; }},
  };
  for (int row : {0, 2}) {  // with bounds of its own, and of friction
    for (const auto& [name, number] : fields) {
      const auto& field = number;
      for (double bad : {kNan, kInfinity, -kInfinity}) {
        ExpectRefused({name, Status::kNotFinite, [&](Scene* s) { *field(&s->rows[row]) = bad; }},
                      row, -1);
      }
    }
  }
}

TEST(Validate, BoundsMayBeInfiniteButNotNan) {
  ExpectRefused({"lo", Status::kNotFinite, [](Scene* s) { s->rows[4].lo = kNan; }}, 4, -1);
  ExpectRefused({"hi", Status::kNotFinite, [](Scene* s) { s->rows[4].hi = kNan; }}, 4, -1);
  Scene scene = GoodScene();
  scene.rows[4].lo = -kInfinity;
  EXPECT_TRUE(test::Solve(Settings{}, scene).report.ok());
}

TEST(Validate, RefusesAWarmStartThatIsNotFinite) {
  const Scene scene = GoodScene();
  Solver solver;
  for (double bad : {PatternValue(), kInfinity, -kInfinity}) {
    std::vector<double> start(scene.rows.size(), 0);
    start[2] = bad;
    const Report report = SolveUntouched(&solver, scene, start);
    EXPECT_EQ(report.status, Status::kNotFinite);
    EXPECT_EQ(report.bad_row, 2);
  }
}

TEST(Validate, RefusesMassesThatNoBodyHas) {
  const auto refuse = [](const std::string& what, const std::function<void(Body*)>& spoil) {
    ExpectRefused({what, Status::kBadMass, [&](Scene* s) { spoil(&s->bodies[2]); }}, -1, 2);
  };
  refuse("negative mass", [](Body* b) { b->inv_mass = -1e-9; });
  refuse("negative factor", [](Body* b) { b->linear_factor.z() = -1; });
  refuse("negative inertia", [](Body* b) { b->inv_inertia(0, 0) = -1; });
  // Eigenvalues 3 and -1.
  refuse("indefinite", [](Body* b) { View(b->inv_inertia) << 1, 2, 0, 2, 1, 0, 0, 0, 1; });
  refuse("indefinite, zero on the diagonal",
         [](Body* b) { View(b->inv_inertia) << 0, 1, 0, 1, 0, 0, 0, 0, 1; });
  refuse("not symmetric", [](Body* b) { b->inv_inertia(0, 1) = 0.1; });
}

TEST(Validate, RefusesRowsOfBodiesThatAreNotThere) {
  const auto refuse = [](int a, int b) {
    ExpectRefused({std::to_string(a) + " and " + std::to_string(b), Status::kNoSuchBody,
                   [&](Scene* s) {
                     s->rows[4].body_a = a;
                     s->rows[4].body_b = b;
                   }},
                  4, -1);
  };
  refuse(-2, 1);
  refuse(1, -2);
  refuse(3, 1);
  refuse(1, 3);
  refuse(std::numeric_limits<int>::max(), 1);
  refuse(std::numeric_limits<int>::min(), 1);
  refuse(1, 1);
}

TEST(Validate, RefusesBoundsThatLeaveNoImpulse) {
  const auto refuse = [](double lo, double hi) {
    ExpectRefused({std::to_string(lo) + " > " + std::to_string(hi), Status::kBadBounds,
                   [&](Scene* s) {
                     s->rows[4].lo = lo;
                     s->rows[4].hi = hi;
                   }},
                  4, -1);
  };
  refuse(1, std::nextafter(1, 0));
  refuse(kInfinity, kInfinity);
  refuse(-kInfinity, -kInfinity);
}

TEST(Validate, RefusesRowNumbersOutOfTheirRange) {
  const auto refuse = [](Status status, const std::string& what, auto member, double bad) {
    ExpectRefused({what, status, [&](Scene* s) { s->rows[2].*member = bad; }}, 2, -1);
  };
  refuse(Status::kBadCompliance, "compliance", &Row::compliance, -1e-300);
  refuse(Status::kBadCompliance, "relaxation 0", &Row::relaxation, 0.0);
  refuse(Status::kBadCompliance, "relaxation 2", &Row::relaxation, 2.0);
  refuse(Status::kBadCompliance, "relaxation -1", &Row::relaxation, -1.0);
  refuse(Status::kBadFriction, "friction", &Row::friction, -1e-300);
  refuse(Status::kBadBounds, "friction that may not be zero, lo", &Row::lo, 0.1);
  refuse(Status::kBadBounds, "friction that may not be zero, hi", &Row::hi, -0.1);
}

TEST(Validate, RefusesParentsThatCannotBeOne) {
  const auto refuse = [](const std::string& what, int parent) {
    ExpectRefused({what, Status::kBadParent, [&](Scene* s) { s->rows[2].parent = parent; }}, 2, -1);
  };
  refuse("later", 4);
  refuse("itself", 2);
  refuse("not there", 100);
  refuse("negative", -2);
  refuse("other bodies", 0);
  ExpectRefused({"friction itself", Status::kBadParent, [](Scene* s) { s->rows[3].parent = 2; }}, 3,
                -1);
}

TEST(Validate, AParentMayNameTheSameBodiesTheOtherWayRound) {
  Scene scene = GoodScene();
  std::swap(scene.rows[2].body_a, scene.rows[2].body_b);
  std::swap(scene.rows[2].linear_a, scene.rows[2].linear_b);
  std::swap(scene.rows[2].angular_a, scene.rows[2].angular_b);
  EXPECT_TRUE(test::Solve(Settings{}, scene).report.ok());
}

TEST(Validate, WantsMotionsOfAllBodiesAlsoWhereThereAreRowsAlone) {
  Scene scene = GoodScene();
  std::vector<ContactMotion> motions(1);
  ContactProblem problem = scene.problem();
  problem.motions = motions;
  std::vector<double> impulses(scene.rows.size());
  std::vector<Velocity> velocities(scene.bodies.size());
  Solver solver;
  const Report report = solver.Solve(problem, {.rows = impulses}, velocities);
  EXPECT_EQ(Describe(report), "problem.motions.size() is 1, must be 0 or problem.bodies.size()");

  motions.resize(scene.bodies.size());
  motions[2].free_spin[1] = std::numeric_limits<float>::infinity();
  problem.motions = motions;
  EXPECT_EQ(Describe(solver.Solve(problem, {.rows = impulses}, velocities)),
            "body 2: motions.free_spin is inf, must be finite");
}

TEST(Validate, NamesTheFirstOffenderAndBodiesBeforeRows) {
  Scene scene = GoodScene();
  scene.rows[1].target = kNan;
  scene.rows[4].lo = kNan;
  EXPECT_EQ(test::Solve(Settings{}, scene).report.bad_row, 1);
  scene.bodies[2].inv_mass = -1;
  const Report report = test::Solve(Settings{}, scene).report;
  EXPECT_EQ(report.bad_body, 2);
  EXPECT_EQ(report.bad_row, -1);
}

TEST(Validate, RefusesAnEmptyProblemAndResultsOfTheWrongSize) {
  Solver solver;
  EXPECT_EQ(solver.Solve(ContactProblem{}, Impulses{}, {}).status, Status::kEmptyProblem);
  EXPECT_EQ(Measure(ContactProblem{}, {}).status, Status::kEmptyProblem);

  const Scene scene = GoodScene();
  for (const auto& [rows, bodies] : {std::pair(4, 3), {6, 3}, {5, 2}, {5, 4}}) {
    const double p = PatternValue();
    std::vector<double> impulses(rows, 0.25);
    std::vector<Velocity> velocities(bodies, {.linear = {p, p, p}, .angular = {p, p, p}});
    const Report report = solver.Solve(scene.problem(), impulses, velocities);
    EXPECT_EQ(report.status, Status::kWrongSize);
    const std::string expected =
        rows != 5
            ? "impulses.rows.size() is " + std::to_string(rows) + ", must be problem.rows.size()"
            : "velocities.size() is " + std::to_string(bodies) + ", must be problem.bodies.size()";
    EXPECT_EQ(Describe(report), expected);
    EXPECT_EQ(report.bad_row, -1);
    EXPECT_EQ(report.bad_body, -1);
    for (double x : impulses) EXPECT_EQ(x, 0.25);
    for (const Velocity& v : velocities) EXPECT_EQ(std::memcmp(&v, &p, sizeof(p)), 0);
  }
  EXPECT_EQ(Measure(scene.problem(), std::vector<double>(3)).status, Status::kWrongSize);
}

TEST(Validate, RefusesATimeStepThatNoneCanMake) {
  const Scene scene = GoodScene();
  for (const double step : {-1.0, kNan, kInfinity}) {
    std::vector<double> impulses(5, 0.25);
    std::vector<Velocity> velocities(3);
    ContactProblem problem = scene.problem();
    problem.time_step = step;
    const Report report = Solver().Solve(problem, impulses, velocities);
    EXPECT_EQ(report.status, Status::kNotFinite);
    EXPECT_STREQ(report.bad_setting.name, "problem.time_step");
    EXPECT_EQ(impulses[0], 0.25);
  }
}

TEST(Validate, RefusesEverySettingOutOfItsRange) {
  const auto refuse = [](const std::string& name, const std::function<void(Settings*)>& spoil) {
    SCOPED_TRACE(name);
    Solver solver;
    spoil(&solver.settings());
    const Scene scene = GoodScene();
    const Report report =
        SolveUntouched(&solver, scene, std::vector<double>(scene.rows.size(), 0.25));
    EXPECT_EQ(report.status, Status::kBadSettings);
    EXPECT_EQ(report.bad_setting.name, name);
    EXPECT_EQ(Describe(report).find(name + " is "), 0u) << Describe(report);
    EXPECT_GT(report.elapsed.count(), 0);
  };
  refuse("method", [](Settings* s) { s->method = static_cast<Method>(3); });
  refuse("path", [](Settings* s) { s->path = static_cast<Path>(3); });
  refuse("k_gs", [](Settings* s) { s->k_gs = 0; });
  refuse("k_sm", [](Settings* s) { s->k_sm = -1; });
  refuse("tuning.min_sweeps", [](Settings* s) { s->tuning.min_sweeps = -2; });
  refuse("max_sweeps", [](Settings* s) { s->max_sweeps = -1; });
  for (double bad : {-1e-300, kNan}) {
    refuse("tolerance", [&](Settings* s) { s->tolerance = bad; });
    refuse("tuning.min_progress", [&](Settings* s) { s->tuning.min_progress = bad; });
  }
  refuse("budget", [](Settings* s) { s->budget = Budget::Time(std::chrono::nanoseconds(-1)); });
  refuse("budget", [](Settings* s) { s->budget = Budget::Work(-1); });
  for (int bad : {-1, 0, 1025}) refuse("threads", [&](Settings* s) { s->threads = bad; });
  for (double bad : {0.0, 2.0, -1.0, kNan})
    refuse("tuning.omega", [&](Settings* s) { s->tuning.omega = bad; });
  refuse("tuning.lifted_friction",
         [](Settings* s) { s->tuning.lifted_friction = static_cast<detail::LiftedFriction>(2); });
  refuse("step_policy", [](Settings* s) { s->step_policy = static_cast<StepPolicy>(-1); });
  for (double bad : {0.99e-8, 1.01, kNan})
    refuse("tuning.proximal", [&](Settings* s) { s->tuning.proximal = bad; });
  for (double bad : {0.99e-12, 1.01, kNan}) {
    refuse("proximal_joints", [&](Settings* s) { s->proximal_joints = bad; });
  }
  refuse("tuning.refinements", [](Settings* s) { s->tuning.refinements = 0; });
}

TEST(Validate, AcceptsTheEndsOfEveryRange) {
  const Settings least{.method = Method::kPgs,
                       .k_gs = 1,
                       .k_sm = 0,
                       .max_sweeps = 0,
                       .tolerance = 0,
                       .budget = Budget::Work(0),
                       .proximal_joints = 1e-12,
                       .tuning = {.omega = 1e-300, .proximal = 1e-8, .refinements = 1}};
  EXPECT_EQ(FindBadSetting(least).name, nullptr);
  const Settings most{.tolerance = kInfinity,
                      .proximal_joints = 1,
                      .tuning = {.min_progress = kInfinity, .omega = 1.999999, .proximal = 1}};
  EXPECT_EQ(FindBadSetting(most).name, nullptr);
  EXPECT_EQ(FindBadSetting(Settings{}).name, nullptr);
}

// Constants need a value in every field: without one this does not compile.
TEST(Defaults, AreThereForAllThatAnEngineFillsIn) {
  constexpr ContactPoint point;
  constexpr ContactImpulse impulse;
  constexpr ContactTwist twist;
  constexpr TwistImpulse twist_impulse;
  constexpr ContactMotion motion;
  constexpr JointRow row;
  constexpr Joint joint;
  constexpr Manifold manifold;
  EXPECT_EQ(point.bias + point.friction + impulse.normal + twist.rolling, 0);
  EXPECT_EQ(twist_impulse.spinning + motion.free_velocity[0], 0);
  EXPECT_EQ(row.lo, -kInfinity);
  EXPECT_EQ(row.hi, kInfinity);
  EXPECT_EQ(joint.body_a, kWorld);
  EXPECT_EQ(joint.body_b, kWorld);
  EXPECT_EQ(joint.rows, 1);
  EXPECT_EQ(manifold.body_a, kWorld);
  EXPECT_EQ(manifold.body_b, kWorld);
  EXPECT_EQ(manifold.points, 1);
}

TEST(Describe, SaysWhichSettingIsOutOfWhichRange) {
  const auto said = [](const Settings& settings) {
    return Describe(test::Solve(settings, GoodScene()).report);
  };
  EXPECT_EQ(said(Settings{.threads = 0}), "threads is 0, must be 1 to 1024");
  EXPECT_EQ(said(Settings{.tolerance = -0.25}), "tolerance is -0.25, must be 0 or more");
  EXPECT_EQ(said(Settings{.tolerance = kNan}), "tolerance is nan, must be 0 or more");
  EXPECT_EQ(said(Settings{.budget = Budget::Work(-3)}), "budget is -3, must be 0 or more");
  // the first of two
  EXPECT_EQ(said(Settings{.k_gs = 0, .threads = 2000}), "k_gs is 0, must be 1 or more");
}

TEST(Describe, SaysWhereAProblemIsBad) {
  Scene scene = GoodScene();
  scene.rows[1].lo = 2;
  scene.rows[1].hi = 1;
  EXPECT_EQ(Describe(test::Solve(Settings{}, scene).report), "row 1: lo is 2, must be at most hi");
  scene.bodies[2].inv_mass = -1;
  EXPECT_EQ(Describe(test::Solve(Settings{}, scene).report),
            "body 2: inv_mass is -1, must be 0 or more");
  scene.bodies[2] = test::Box(1, {1, 1, 1});
  scene.bodies[2].inv_inertia(0, 1) = 3;
  EXPECT_EQ(Describe(test::Solve(Settings{}, scene).report),
            "body 2: " + std::string(Describe(Status::kBadMass)));
  EXPECT_EQ(Describe(Solver().Solve(ContactProblem{}, Impulses{}, {})),
            Describe(Status::kEmptyProblem));
  EXPECT_EQ(Describe(test::Solve(Settings{}, GoodScene()).report),
            Describe(StopReason::kStationary));
}

/// A body that turns about one axis only, in the rounding of a float engine: the matrix has rank 1
/// up to 1e-7, and what is left of it after the first pivot is noise of either sign.
TEST(FactorInertia, TakesTheRoundingOfFloatsForZero) {
  test::Random random(11);
  int refused = 0;
  double largest = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Matrix3f axes = random.Rotation().cast<float>();
    const Eigen::Matrix3f inertia = axes * Eigen::Vector3f(0, 0, 1).asDiagonal() * axes.transpose();
    const Eigen::Matrix3d wanted = inertia.cast<double>();
    Eigen::Matrix3d factor;
    if (!FactorInertia(wanted, &factor)) ++refused;
    largest = std::max(largest, (factor * factor.transpose() - wanted).cwiseAbs().maxCoeff());
  }
  EXPECT_EQ(refused, 0);
  EXPECT_LT(largest, 2e-5);  // the tolerance it promises, on either side
}

// About (1, 1, 1), with an entry off the diagonal one rounding above those on it.
TEST(FactorInertia, TakesEqualEntriesForEqual) {
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Ones();
  inertia(0, 2) = inertia(2, 0) = std::nextafter(1.0f, 2.0f);
  Eigen::Matrix3d factor;
  ASSERT_TRUE(FactorInertia(inertia, &factor));
  EXPECT_LT((factor * factor.transpose() - inertia).cwiseAbs().maxCoeff(), 1e-6);
}

// A product of the factor is the matrix to the rounding of doubles, whatever its shape.
TEST(FactorInertia, IsExactForBodiesOfFullRank) {
  test::Random random(12);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Matrix3d inertia = test::RandomBody(&random).inv_inertia;
    Eigen::Matrix3d factor;
    ASSERT_TRUE(FactorInertia(inertia, &factor));
    const double error = (factor * factor.transpose() - inertia).cwiseAbs().maxCoeff();
    EXPECT_LT(error, 1e-14 * inertia.maxCoeff());
  }
}

}  // namespace
}  // namespace cairn
