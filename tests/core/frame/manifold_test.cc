// SPDX-License-Identifier: MIT
// Manifolds and joints are their rows: the same numbers, the same answers, on every target.
#include "cairn/manifold.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "cairn/detail/eigen.h"
#include "pack/block_frame.h"
#include "problem/contact_expansion.h"
#include "tests/core/support/block_problems.h"
#include "tests/core/support/manifold_problems.h"

namespace cairn {
namespace {

using test::ManifoldScene;

/// Sums of some ten products of numbers of up to ten, in floats.
constexpr double kFloat = 5e-5;

struct Solved {
  Report report;
  std::vector<double> rows;
  std::vector<ContactImpulse> points;
  std::vector<TwistImpulse> twists;
  std::vector<float> joint_rows;
  std::vector<Velocity> velocities;
};

/// Seeds stand for scenes; odd ones roll, and half of both have joints, too.
ManifoldScene AnyManifolds(int bodies, int manifolds, std::uint64_t seed) {
  ManifoldScene scene = seed % 2 == 1 ? test::RollingManifolds(bodies, manifolds, seed)
                                      : test::RandomManifolds(bodies, manifolds, seed);
  if (seed % 4 >= 2) test::AddJoints(bodies / 4, seed, &scene);
  return scene;
}

Solved Solve(Solver* solver, ManifoldScene scene) {
  Solved solved;
  solved.velocities.resize(scene.bodies.size());
  solved.report = solver->Solve(scene.problem(), scene.impulses(), solved.velocities);
  solved.rows = scene.row_impulses;
  solved.points = scene.point_impulses;
  solved.twists = scene.twist_impulses;
  solved.joint_rows = scene.joint_impulses;
  return solved;
}

Solved Solve(const Settings& settings, const ManifoldScene& scene) {
  Solver solver(settings);
  return Solve(&solver, scene);
}

/// The rows that the manifolds stand for, as a scene without any.
test::Scene RowsOf(ManifoldScene scene, std::vector<double>* start) {
  ContactExpansion expansion(scene.problem(), scene.impulses());
  test::Scene rows;
  rows.bodies = scene.bodies;
  rows.rows.assign(expansion.problem().rows.begin(), expansion.problem().rows.end());
  start->assign(expansion.impulses().begin(), expansion.impulses().end());
  return rows;
}

/// G of one side of a row.
std::vector<double> Side(const WhitenedBody& body, const Eigen::Vector3d& linear,
                         const Eigen::Vector3d& angular) {
  const Eigen::Vector3d g = body.linear.cwiseProduct(linear);
  const Eigen::Vector3d turn = body.angular.transpose() * angular;
  return {g.x(), g.y(), g.z(), turn.x(), turn.y(), turn.z()};
}

/// By how much R of a body is larger for a lane that sees a copy of it.
double ScaleAt(const Plan& plan, int slot) {
  const simd::BodyCopy* const copy = plan.copy_at(slot);
  return copy != nullptr ? 1 / copy->share : 1;
}

/// The lines of a row as a kernel must have them, from the row itself.
std::vector<double> LinesOf(const BlockFrame& frame, std::span<const Body> bodies, const Row& row,
                            int block, int lane, const simd::RowShape& shape) {
  const Pair& pair = frame.plan().pair(block, lane);
  const simd::PairBlock& of = frame.plan().blocks()[block];
  const double scale_a = ScaleAt(frame.plan(), of.a[lane]),
               scale_b = ScaleAt(frame.plan(), of.b[lane]);
  const auto body = [&](int i) {
    WhitenedBody seen;
    if (i == kWorld) return seen;
    seen = frame.bodies()[i];
    const double scale = i == pair.a ? scale_a : i == pair.b ? scale_b : 1;
    seen.linear *= scale;
    seen.angular *= scale;
    return seen;
  };
  const bool straight = row.body_a == pair.a;
  const auto a = straight ? Side(body(pair.a), row.linear_a, row.angular_a)
                          : Side(body(pair.a), row.linear_b, row.angular_b);
  const auto b = straight ? Side(body(pair.b), row.linear_b, row.angular_b)
                          : Side(body(pair.b), row.linear_a, row.angular_a);
  double d = row.compliance, target = row.target, denied = 0;
  for (const double g : a) d += g * g;
  for (const double g : b) d += g * g;
  const auto subtract = [&](int i, const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) {
    if (i == kWorld) return;
    const double scale = i == pair.a ? scale_a : scale_b;
    denied += scale * scale * test::DeniedByLocks(bodies[i], linear);
    target -= linear.dot(View(body(i).free.linear)) + angular.dot(View(body(i).free.angular));
  };
  subtract(row.body_a, row.linear_a, row.angular_a);
  subtract(row.body_b, row.linear_b, row.angular_b);

  std::vector<double> lines = a;
  if (pair.form == simd::PairForm::kContact) {
    const double r = std::hypot(body(pair.a).linear[0], body(pair.b).linear[0]);
    for (int k = 0; k < 3; ++k) lines[k] = r * (straight ? row.linear_a : row.linear_b)[k];
    lines.insert(lines.end(), b.begin() + 3, b.end());
  }
  if (pair.form == simd::PairForm::kJoint) lines.insert(lines.end(), b.begin(), b.end());
  lines.push_back(d > 0 ? target : 0);
  lines.push_back(d > 0 ? 1 / (d + denied) : 1);
  if (shape.soft) lines.push_back(row.compliance);
  if (shape.parent >= 0) lines.push_back(row.friction);
  if (shape.bound == simd::RowBound::kCutFriction || shape.bound == simd::RowBound::kOwn)
    lines.insert(lines.end(), {row.lo, row.hi});
  return lines;
}

TEST(Manifold, HasTheLinesOfItsRows) {
  size_t copies = 0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    // every body is a hub in the second half of them
    ManifoldScene scene = AnyManifolds(20, seed <= 8 ? 120 : 600, seed);
    std::vector<double> start;
    const test::Scene rows = RowsOf(scene, &start);
    std::vector<int> first_of_joint, first_of_manifold;
    int next = 0;
    for (const Joint& joint : scene.joints) {
      first_of_joint.push_back(next);
      next += joint.rows;
    }
    for (const Manifold& manifold : scene.manifolds) {
      first_of_manifold.push_back(next);
      next += manifold.rows();
    }
    ASSERT_EQ(next, static_cast<int>(rows.rows.size()));

    BlockFrame frame;
    Crew crew(1);
    ASSERT_EQ(frame.Begin(scene.problem(), 1, scene.impulses(), &crew), PackResult::kDone);
    const Plan& plan = frame.plan();
    copies += plan.copies().size();
    int lanes = 0;
    for (int b = 0; b < static_cast<int>(plan.blocks().size()); ++b) {
      const simd::PairBlock& block = plan.blocks()[b];
      for (int lane = 0; lane < block.lanes; ++lane, ++lanes) {
        const Pair& pair = plan.pair(b, lane);
        const bool joint = pair.source == RowSource::kJoint;
        const int first = (joint ? first_of_joint : first_of_manifold)[pair.index];
        const simd::Line* line = &frame.blocks().data[block.data] + simd::PairLines(block.form);
        std::vector<double> x, before;
        for (int i = 0; i < block.row_count; ++i) {
          const int index = first + i;
          const Row& row = rows.rows[index];
          const std::vector<double> lines =
              LinesOf(frame, scene.bodies, row, b, lane, block.rows[i]);
          for (const double expected : lines) {
            const double tolerance = kFloat * (1 + std::abs(expected));
            const double actual = (line++)->lane[lane];
            if (actual == expected) continue;  // infinity, too
            ASSERT_NEAR(actual, expected, tolerance) << seed << " row " << i;
          }
          double coupling = 0, size = 1;
          for (int k = 0; k < simd::JacobianLines(block.form) && i > 0; ++k) {
            coupling += lines[k] * before[k];
            size += std::abs(lines[k] * before[k]);
          }
          ASSERT_NEAR((line++)->lane[lane], coupling, 2 * kFloat * size) << seed << " row " << i;
          before = lines;
          // the start, inside its bounds
          const double most =
              row.parent == kNoRow ? kInfinity : row.friction * x[row.parent - first];
          x.push_back(std::clamp(start[index], std::max(-most, row.lo), std::min(most, row.hi)));
          ASSERT_NEAR(frame.blocks().x[block.x + i].lane[lane], x.back(), kFloat) << "row " << i;
        }
      }
    }
    EXPECT_EQ(lanes, static_cast<int>(scene.manifolds.size() + scene.joints.size()));
  }
  EXPECT_GT(copies, 100u);
}

TEST(Manifold, EndsWhereItsRowsEnd) {
  // to a residual that floats can tell
  Settings settings;
  settings.tolerance = 2e-5;
  settings.max_sweeps = 20000;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    ManifoldScene scene = AnyManifolds(30, 40, seed);
    // what is rigid may contradict itself
    for (Joint& joint : scene.joints) joint.soft = true;
    for (JointRow& row : scene.joint_rows) row.compliance = 0.1f;
    const Solved manifolds = Solve(settings, scene);
    ASSERT_TRUE(manifolds.report.ok());
    std::vector<double> start;
    const test::Scene rows = RowsOf(scene, &start);

    // the solution to compare with knows rows alone
    ManifoldScene solved = scene;
    solved.point_impulses = manifolds.points;
    solved.twist_impulses = manifolds.twists;
    solved.joint_impulses = manifolds.joint_rows;
    const std::vector<double> x = AllImpulses(solved.problem(), solved.impulses());
    const Report measured = Measure(rows.problem(), x);
    ASSERT_TRUE(measured.ok());
    EXPECT_LE(measured.residual_max, 5e-5);
    EXPECT_EQ(Measure(scene.problem(), x).residual_max, measured.residual_max);
  }
}

// A point that hardly slides slides another way in floats than in doubles.
TEST(Manifold, HasImpulsesAlongTheDirectionsThatAreMeasured) {
  std::vector<Body> bodies(1);
  bodies[0].inv_mass = 1;
  bodies[0].velocity.linear = Eigen::Vector3d(1, 0, 0);
  const std::vector<ContactPoint> points = {{.normal = {0, 1, 0}, .friction = 1}};
  const std::vector<Manifold> manifolds = {{.body_a = 0, .body_b = kWorld, .points = 1}};
  // along the axis z, and along that across the normal
  std::vector<ContactImpulse> impulses = {
      {.normal = 1, .tangential = {0.3f, 0.1f}, .heading = 2, .direction = {0, 0, 1}}};
  const ContactProblem problem{.bodies = bodies, .manifolds = manifolds, .points = points};
  const std::vector<double> x = AllImpulses(problem, {.points = impulses});
  ASSERT_EQ(x.size(), 3u);
  EXPECT_EQ(x[0], 1);
  EXPECT_NEAR(x[1], -0.1, 1e-7);
  EXPECT_NEAR(x[2], 0.3, 1e-7);
}

TEST(Manifold, IsSolvedInDoubleLikeItsRows) {
  const Settings settings = test::PlainSweeps(30);
  ManifoldScene scene = AnyManifolds(20, 40, 3);
  ASSERT_FALSE(scene.joints.empty());
  std::vector<double> start;
  const test::Scene rows = RowsOf(scene, &start);
  const test::Solution expected = test::Solve(settings, rows, start);
  const Solved manifolds = Solve(settings, scene);

  EXPECT_EQ(test::Distance(manifolds.velocities, expected.v), 0);
  EXPECT_EQ(manifolds.report.sweeps, 30);
}

TEST(Manifold, HasTheSameBitsOnEveryTargetAndThread) {
  for (const ManifoldScene& scene :
       {test::RandomManifolds(60, 300, 5), AnyManifolds(600, 1500, 7)}) {
    Settings settings = test::ColouredSteps(20);
    const Solved expected = Solve(settings, scene);
    ASSERT_TRUE(expected.report.ok());
    for (const simd::Target target : simd::SupportedTargets()) {
      const test::AskFor asked(target);
      for (const int threads : {1, 2, 3}) {
        settings.threads = threads;
        const Solved other = Solve(settings, scene);
        EXPECT_TRUE(test::SameBits(other.points, expected.points)) << simd::TargetName(target);
        EXPECT_TRUE(std::ranges::equal(other.twists, expected.twists, test::SameTwist));
        EXPECT_EQ(other.joint_rows, expected.joint_rows);
        EXPECT_EQ(test::Distance(other.velocities, expected.velocities), 0);
      }
    }
  }
}

// A wide register has lanes beyond those of a block. What is there is refused nowhere, or
// everywhere.
TEST(Manifold, FitsFloatsOnEveryTargetOrOnNone) {
  for (const bool second : {false, true}) {
    // 3e4 m from its centre a body that turns by 3e11 rad/s: far, and easily moved
    ManifoldScene scene = test::ManifoldTower(1);
    scene.points.resize(1);
    scene.point_impulses.resize(1);
    scene.manifolds[0].points = 1;
    scene.bodies[0].velocity.angular = {0, 0, 3e11};
    ContactPoint& point = scene.points[0];
    point.arm_a[0] = point.arm_b[0] = 3e4f;
    if (second) std::swap(scene.manifolds[0].body_a, scene.manifolds[0].body_b);
    const Solved expected = Solve(Settings{}, scene);
    ASSERT_TRUE(expected.report.ok());
    EXPECT_EQ(expected.report.path, Path::kFast);
    for (const simd::Target target : simd::SupportedTargets()) {
      const test::AskFor asked(target);
      const Solved other = Solve(Settings{}, scene);
      EXPECT_EQ(other.report.path, Path::kFast) << simd::TargetName(target);
      EXPECT_TRUE(test::SameBits(other.points, expected.points)) << simd::TargetName(target);
    }
  }
}

TEST(Manifold, StandsBesideRows) {
  // a tower of manifolds, and the same tower of rows
  ManifoldScene scene = test::ManifoldTower(5);
  const test::Scene tower = test::Tower(5);
  for (Row row : tower.rows) {
    for (int* body : {&row.body_a, &row.body_b}) *body += *body == kWorld ? 0 : 5;
    scene.rows.push_back(row);
  }
  scene.bodies.insert(scene.bodies.end(), tower.bodies.begin(), tower.bodies.end());
  scene.row_impulses.assign(scene.rows.size(), 0);
  const Solved solved = Solve(Settings{}, scene);
  ASSERT_TRUE(solved.report.ok());
  EXPECT_EQ(solved.report.stop, StopReason::kConverged);
  ASSERT_EQ(solved.report.islands.size(), 2u);
  EXPECT_EQ(solved.report.islands[0].rows, solved.report.islands[1].rows);
  for (const Velocity& velocity : solved.velocities) {
    EXPECT_NEAR(View(velocity.linear).norm(), 0, 5e-3);
  }
  // by hand: each face carries what is above it
  for (int i = 0; i < 5; ++i) {
    double carried = 0;
    for (int p = 0; p < 4; ++p) carried += solved.points[4 * i + p].normal;
    EXPECT_NEAR(carried, (5 - i) * test::kGravityStep, 5e-3);
  }
}

TEST(Manifold, KeepsItsPlanWhileItsPointsStay) {
  ManifoldScene scene = test::RandomManifolds(20, 50, 4);
  BlockFrame frame;
  Crew crew(1);
  ASSERT_EQ(frame.Begin(scene.problem(), 1, scene.impulses(), &crew), PackResult::kDone);
  scene.points[3].bias = 0.25f;
  ASSERT_EQ(frame.Begin(scene.problem(), 1, scene.impulses(), &crew), PackResult::kDone);
  EXPECT_EQ(frame.plan_number(), 1);
  scene.manifolds[7].tangents = scene.manifolds[7].tangents == 2 ? 1 : 2;
  ASSERT_EQ(frame.Begin(scene.problem(), 1, scene.impulses(), &crew), PackResult::kDone);
  EXPECT_EQ(frame.plan_number(), 2);
}

TEST(Manifold, HardlyHoldsAcrossItsWayWhatSlidesFast) {
  constexpr float kFriction = 0.5f;
  // the coefficient along t2 of a body that slides along x at this speed
  const auto across = [](const ManifoldScene& scene) {
    std::vector<double> start;
    const test::Scene rows = RowsOf(scene, &start);
    EXPECT_DOUBLE_EQ(rows.rows[scene.manifolds[0].points].friction, kFriction);
    return rows.rows[scene.manifolds[0].points + 1].friction;
  };
  ManifoldScene scene = test::ManifoldTower(1);
  View(scene.bodies[0].inv_inertia).setZero();
  for (ContactPoint& point : scene.points) point.friction = kFriction;
  const double fall = View(scene.bodies[0].impulse).norm() * scene.bodies[0].inv_mass;
  ASSERT_GT(fall, 0);
  const auto sliding = [&](double speed) {
    scene.bodies[0].velocity.linear = {speed, 0, 0};
    return across(scene);
  };
  EXPECT_NEAR(sliding(5), kFriction * kFriction * fall / 5, 1e-9);
  EXPECT_NEAR(sliding(-5), kFriction * kFriction * fall / 5, 1e-9);
  EXPECT_DOUBLE_EQ(sliding(0.9 * kFriction * fall), kFriction) << "friction stops it in this step";
  EXPECT_DOUBLE_EQ(sliding(0), kFriction);

  // one that lands is held by more than its weight
  scene.bodies[0].velocity.linear = {5, -3, 0};
  EXPECT_NEAR(across(scene), kFriction * kFriction * (3 + fall) / 5, 1e-6);

  // directions of the user's own say nothing of where a point slides to
  for (ContactPoint& point : scene.points) point.tangent[2] = 1;
  EXPECT_DOUBLE_EQ(sliding(5), kFriction);
  for (ContactPoint& point : scene.points) point.tangent[2] = 0;
  scene.law.host.bounded_apart = true;
  EXPECT_DOUBLE_EQ(sliding(5), kFriction);
}

TEST(Manifold, TurnsItsStartIntoTheDirectionsOfTheFrame) {
  // a box that slides along x: by hand, the first axis of the plane across y is -x, the second is
  // y x -x = z, t1 = x, t2 = x x y = z
  ManifoldScene scene = test::ManifoldTower(1);
  scene.bodies[0].velocity.linear = {1, 0, 0};
  View(scene.bodies[0].inv_inertia).setZero();
  scene.manifolds[0].points = 1;
  scene.law.host.bounded_apart = true;
  // last frame t1 was the second axis, z, and t2 = z x y = -x
  scene.point_impulses[0] = {.normal = 1, .tangential = {0.25f, 0.125f}, .heading = 2};
  for (const Path path : {Path::kFast, Path::kReference}) {
    Settings settings = test::Coloured(0);
    settings.path = path;
    const Solved solved = Solve(settings, scene);
    ASSERT_TRUE(solved.report.ok());
    EXPECT_FLOAT_EQ(solved.points[0].direction[0], 1);
    EXPECT_FLOAT_EQ(solved.points[0].tangential[0], -0.125f);
    EXPECT_FLOAT_EQ(solved.points[0].tangential[1], 0.25f);
    EXPECT_FLOAT_EQ(solved.points[0].heading, 3);  // against the first axis

    // given back, it stays what it is
    scene.point_impulses[0] = solved.points[0];
    const Solved again = Solve(settings, scene);
    EXPECT_FLOAT_EQ(again.points[0].tangential[0], -0.125f);
    EXPECT_FLOAT_EQ(again.points[0].tangential[1], 0.25f);
    scene.point_impulses[0] = {.normal = 1, .tangential = {0.25f, 0.125f}, .heading = 2};
  }
}

TEST(Manifold, ResistsTurningAsFarAsItIsPressed) {
  // a ball of 1 kg and inertia 1 kg m^2 presses with 2 N s, and spins about the normal, y, at 1
  // rad/s; about x, across it, at -0.5. By hand: 0.25 m times 2 N s end half of the spin, 0.1 N m s
  // are the most against rolling. The plane across y is that of -x and z.
  ManifoldScene scene = test::ManifoldTower(1);
  scene.bodies[0].inv_inertia = Eigen::Matrix3d::Identity();
  scene.bodies[0].impulse = {0, -2, 0};
  scene.bodies[0].velocity.angular = {-0.5, 1, 0};
  scene.manifolds[0].points = 1;
  scene.manifolds[0].tangents = 0;
  scene.manifolds[0].twists = true;
  scene.points[0].arm_a[0] = scene.points[0].arm_a[2] = 0;
  scene.twists.resize(scene.points.size());
  scene.twist_impulses.resize(scene.points.size());
  scene.twists[0] = {.spinning = 0.25f, .rolling = 10, .most_spinning = 10, .most_rolling = 0.1f};
  for (const Path path : {Path::kFast, Path::kReference}) {
    Settings settings;
    settings.path = path;
    const Solved solved = Solve(settings, scene);
    ASSERT_TRUE(solved.report.ok());
    EXPECT_NEAR(solved.twists[0].spinning, -0.5, kFloat);
    EXPECT_NEAR(solved.twists[0].rolling[0], -0.1, kFloat);
    EXPECT_NEAR(solved.twists[0].rolling[1], 0, kFloat);
    const Eigen::Vector3d spin(-0.4, 0.5, 0);
    EXPECT_NEAR((View(solved.velocities[0].angular) - spin).norm(), 0, kFloat);
  }
}

TEST(Manifold, IsRefusedWithABounceSpeedThatIsNoSpeed) {
  for (const float speed : {-1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    ManifoldScene scene = test::RandomManifolds(10, 20, 2);
    scene.law.bounce_speed = speed;
    const Report report = Solve(Settings{}, scene).report;
    EXPECT_EQ(report.status, Status::kNotFinite);
    EXPECT_EQ(Describe(report), std::string("problem.contact_law.bounce_speed is ") +
                                    (speed < 0 ? "-1" : "nan") + ", must be 0 or more");
  }
}

TEST(Manifold, ThatIsRefusedIsNamedByItsField) {
  const auto said = [](void (*spoil)(Manifold*)) {
    ManifoldScene scene = test::RandomManifolds(10, 20, 2);
    spoil(&scene.manifolds[7]);
    return Describe(Solve(Settings{}, scene).report);
  };
  EXPECT_EQ(said([](Manifold* m) { m->points = 5; }), "manifold 7: points is 5, must be 1 to 4");
  EXPECT_EQ(said([](Manifold* m) { m->tangents = -1; }),
            "manifold 7: tangents is -1, must be 0 to 2");
  EXPECT_EQ(said([](Manifold* m) { m->first_point = 2000; }),
            "manifold 7: first_point is 2000, must be 0 to problem.points.size() - points");
  EXPECT_EQ(said([](Manifold* m) { m->twists = true; }),
            "manifold 7: twists is 1, must be 0 without problem.twists");
  EXPECT_EQ(said([](Manifold* m) { m->body_a = 10; }),
            "manifold 7: body_a is 10, must be kWorld or below problem.bodies.size()");
}

struct Bad {
  const char* name;
  Status status;
  void (*spoil)(ManifoldScene*);
};

class BadManifold : public testing::TestWithParam<Bad> {};

TEST_P(BadManifold, IsRefusedAndNothingIsWritten) {
  for (const Path path : {Path::kFast, Path::kReference}) {
    ManifoldScene scene = test::RollingManifolds(10, 20, 2);
    scene.manifolds[5].twists = true;
    GetParam().spoil(&scene);
    const std::vector<ContactImpulse> before = scene.point_impulses;
    Settings settings;
    settings.path = path;
    Solver solver(settings);
    std::vector<Velocity> velocities(scene.bodies.size());
    velocities[0].linear.x() = 7;
    const Report report = solver.Solve(scene.problem(), scene.impulses(), velocities);
    EXPECT_EQ(report.status, GetParam().status);
    EXPECT_NE(report.bad_setting.name, nullptr);
    EXPECT_EQ(
        report.bad_manifold,
        GetParam().status == Status::kWrongSize && scene.twists.size() != before.size() ? -1 : 5);
    EXPECT_TRUE(test::SameBits(scene.point_impulses, before));
    EXPECT_EQ(velocities[0].linear.x(), 7);
  }
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
const Bad kBad[] = {
    {"NoPoints", Status::kWrongSize, [](ManifoldScene* s) { s->manifolds[5].points = 0; }},
    {"FivePoints", Status::kWrongSize, [](ManifoldScene* s) { s->manifolds[5].points = 5; }},
    {"ThreeTangents", Status::kWrongSize, [](ManifoldScene* s) { s->manifolds[5].tangents = 3; }},
    {"NegativeFirst", Status::kWrongSize,
     [](ManifoldScene* s) { s->manifolds[5].first_point = -1; }},
    {"PointsBeyondTheEnd", Status::kWrongSize,
     [](ManifoldScene* s) { s->manifolds[5].first_point = 2147483647; }},
    {"SameBodyTwice", Status::kNoSuchBody,
     [](ManifoldScene* s) { s->manifolds[5].body_a = s->manifolds[5].body_b = 3; }},
    {"UnknownBody", Status::kNoSuchBody, [](ManifoldScene* s) { s->manifolds[5].body_a = 10; }},
    {"NanArm", Status::kNotFinite,
     [](ManifoldScene* s) { s->points[s->manifolds[5].first_point].arm_a[1] = kNan; }},
    {"NanNormal", Status::kNotFinite,
     [](ManifoldScene* s) { s->points[s->manifolds[5].first_point].normal[1] = kNan; }},
    {"NanBias", Status::kNotFinite,
     [](ManifoldScene* s) { s->points[s->manifolds[5].first_point].bias = kNan; }},
    {"NanRestitution", Status::kNotFinite,
     [](ManifoldScene* s) { s->points[s->manifolds[5].first_point].restitution = kNan; }},
    {"NanStart", Status::kNotFinite,
     [](ManifoldScene* s) { s->point_impulses[s->manifolds[5].first_point].normal = kNan; }},
    {"NanSpinning", Status::kNotFinite,
     [](ManifoldScene* s) { s->twists[s->manifolds[5].first_point].spinning = kNan; }},
    {"NanMostRolling", Status::kNotFinite,
     [](ManifoldScene* s) { s->twists[s->manifolds[5].first_point].most_rolling = kNan; }},
    {"NanStartOfRolling", Status::kNotFinite,
     [](ManifoldScene* s) { s->twist_impulses[s->manifolds[5].first_point].rolling[1] = kNan; }},
    {"NegativeRolling", Status::kBadFriction,
     [](ManifoldScene* s) { s->twists[s->manifolds[5].first_point].rolling = -1; }},
    {"NegativeMostSpinning", Status::kBadFriction,
     [](ManifoldScene* s) { s->twists[s->manifolds[5].first_point].most_spinning = -1; }},
    {"NoTwists", Status::kWrongSize, [](ManifoldScene* s) { s->twists.clear(); }},
    {"NegativeFriction", Status::kBadFriction,
     [](ManifoldScene* s) { s->points[s->manifolds[5].first_point].friction = -1; }},
    {"NegativeCompliance", Status::kBadCompliance,
     [](ManifoldScene* s) {
       s->manifolds[5].soft = true;
       s->points[s->manifolds[5].first_point].compliance = -1;
     }},
};
INSTANTIATE_TEST_SUITE_P(Inputs, BadManifold, testing::ValuesIn(kBad),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace cairn
