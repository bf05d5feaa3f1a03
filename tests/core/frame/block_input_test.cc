// SPDX-License-Identifier: MIT
// Input that the block path cannot use: refused as the reference refuses it, without a trace, or
// solved in double precision where only floats are too small.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "cairn/detail/eigen.h"
#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using test::Coloured;
using test::Scene;
using test::Solution;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// What is done to a good scene, and to its start.
struct Spoiled {
  std::string what;
  std::function<void(Scene*, std::vector<double>*)> make;
};

Scene GoodScene() {
  Scene scene = test::Together({test::Tower(3), test::HangingChain(4, 2)});
  scene.bodies.push_back(Body{});  // number 7, immovable
  scene.positions.emplace_back(0, 0, 0);
  const int row = static_cast<int>(scene.rows.size());
  scene.rows.push_back(test::PushRow(2, 7, {1, 0, 0}));
  scene.rows.push_back(test::LinearRow(2, 7, {0, 1, 0}));
  scene.rows.back().parent = row;
  scene.rows.back().friction = 0.3;
  return scene;
}

/// Every number of a body or a row that can be something else.
template <class T>
struct Field {
  std::string name;
  std::function<double*(T*)> number;
};

const std::vector<Field<Body>> kBodyFields = {
    {"inv_mass", [](Body* b) { return &b->inv_mass; }},
    {"inv_inertia diagonal", [](Body* b) { return &b->inv_inertia(1, 1); }},
    {"inv_inertia", [](Body* b) { return &b->inv_inertia(2, 1); }},
    {"inv_inertia above", [](Body* b) { return &b->inv_inertia(0, 2); }},
    {"linear_factor", [](Body* b) { return &b->linear_factor.y(); }},
    {"velocity.linear", [](Body* b) { return &b->velocity.linear.z(); }},
    {"velocity.angular", [](Body* b) { return &b->velocity.angular.x(); }},
    {"impulse", [](Body* b) { return &b->impulse.y(); }},
    {"angular_impulse", [](Body* b) { return &b->angular_impulse.z(); }},
};
const std::vector<Field<Row>> kRowFields = {
    {"linear_a", [](Row* r) { return &r->linear_a.x(); }},
    {"linear_a z", [](Row* r) { return &r->linear_a.z(); }},
    {"angular_a", [](Row* r) { return &r->angular_a.y(); }},
    {"linear_b", [](Row* r) { return &r->linear_b.x(); }},
    {"linear_b z", [](Row* r) { return &r->linear_b.z(); }},
    {"angular_b", [](Row* r) { return &r->angular_b.x(); }},
    {"target", [](Row* r) { return &r->target; }},
    {"compliance", [](Row* r) { return &r->compliance; }},
    {"lo", [](Row* r) { return &r->lo; }},
    {"hi", [](Row* r) { return &r->hi; }},
    {"friction", [](Row* r) { return &r->friction; }},
    {"relaxation", [](Row* r) { return &r->relaxation; }},
};

/// Numbers that are none, in a body that moves and in one that does not, in rows on the world, on a
/// body that does not move, of a contact and of a joint, of normals and of friction.
std::vector<Spoiled> NotFinite() {
  std::vector<Spoiled> all;
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (const auto& field : kBodyFields) {
      for (const int body : {1, 7}) {
        all.push_back({field.name + " of body " + std::to_string(body),
                       [field, body, bad](Scene* s, std::vector<double>*) {
                         *field.number(&s->bodies[body]) = bad;
                       }});
      }
    }
    for (const auto& field : kRowFields) {
      for (const int row : {0, 1, 12, 13, 36, 40, 48, 49}) {
        all.push_back({field.name + " of row " + std::to_string(row),
                       [field, row, bad](Scene* s, std::vector<double>*) {
                         *field.number(&s->rows[row]) = bad;
                       }});
      }
    }
    for (const int row : {0, 13, 49}) {
      all.push_back({"start of row " + std::to_string(row),
                     [row, bad](Scene*, std::vector<double>* x) { (*x)[row] = bad; }});
    }
  }
  return all;
}

std::vector<Spoiled> Wrong() {
  using Start = std::vector<double>;
  return {
      {"negative mass", [](Scene* s, Start*) { s->bodies[1].inv_mass = -1; }},
      {"negative factor", [](Scene* s, Start*) { s->bodies[1].linear_factor.x() = -1; }},
      {"lopsided inertia", [](Scene* s, Start*) { s->bodies[1].inv_inertia(0, 1) = 1; }},
      {"indefinite inertia", [](Scene* s, Start*) { s->bodies[1].inv_inertia(2, 2) = -1; }},
      {"body beyond", [](Scene* s, Start*) { s->rows[13].body_a = 8; }},
      {"body far beyond", [](Scene* s, Start*) { s->rows[13].body_b = 1 << 30; }},
      {"body below", [](Scene* s, Start*) { s->rows[13].body_b = -2; }},
      {"body far below", [](Scene* s, Start*) { s->rows[1].body_b = -(1 << 30); }},
      {"one body", [](Scene* s, Start*) { s->rows[12].body_b = s->rows[12].body_a; }},
      {"one immovable body", [](Scene* s, Start*) { s->rows[48].body_a = 7; }},
      {"lo above hi", [](Scene* s, Start*) { s->rows[12].hi = -1; }},
      {"lo above hi of a joint", [](Scene* s, Start*) { s->rows[40].lo = 2, s->rows[40].hi = 1; }},
      {"friction must push", [](Scene* s, Start*) { s->rows[13].lo = 0.1; }},
      {"friction must pull", [](Scene* s, Start*) { s->rows[13].hi = -0.1; }},
      {"compliance", [](Scene* s, Start*) { s->rows[13].compliance = -1e-9; }},
      {"no relaxation", [](Scene* s, Start*) { s->rows[13].relaxation = 0; }},
      {"backwards", [](Scene* s, Start*) { s->rows[0].relaxation = -1; }},
      {"relaxation", [](Scene* s, Start*) { s->rows[13].relaxation = 2; }},
      {"friction", [](Scene* s, Start*) { s->rows[13].friction = -0.1; }},
      {"friction of a normal", [](Scene* s, Start*) { s->rows[12].friction = -0.1; }},
      {"own parent", [](Scene* s, Start*) { s->rows[13].parent = 13; }},
      {"later parent", [](Scene* s, Start*) { s->rows[13].parent = 15; }},
      {"parent of other bodies", [](Scene* s, Start*) { s->rows[13].parent = 0; }},
      {"friction of friction", [](Scene* s, Start*) { s->rows[14].parent = 13; }},
      {"parent beyond", [](Scene* s, Start*) { s->rows[13].parent = 1 << 30; }},
      {"parent below", [](Scene* s, Start*) { s->rows[13].parent = -2; }},
      {"parent by way of the world", [](Scene* s, Start*) { s->rows[49].body_b = kWorld; }},
  };
}

/// Solves what is spoiled; nothing may be written.
Report Refused(Solver* solver, const Scene& scene, const std::vector<double>& start) {
  std::vector<double> impulses = start;
  const Velocity mark{.linear = {1, 2, 3}, .angular = {4, 5, 6}};
  std::vector<Velocity> velocities(scene.bodies.size(), mark);
  const std::vector<Velocity> before = velocities;
  const Report report = solver->Solve(scene.problem(), impulses, velocities);
  EXPECT_FALSE(report.ok());
  EXPECT_EQ(std::memcmp(impulses.data(), start.data(), start.size() * sizeof(double)), 0);
  EXPECT_EQ(std::memcmp(velocities.data(), before.data(), velocities.size() * sizeof(Velocity)), 0);
  return report;
}

/// As the reference says it, in a first frame and in one of many.
void ExpectRefused(const Spoiled& spoiled) {
  SCOPED_TRACE(spoiled.what);
  Scene bad = GoodScene();
  std::vector<double> start(bad.rows.size(), 0.25);
  spoiled.make(&bad, &start);
  Solver reference(test::PlainSweeps(5));
  const Report expected = Refused(&reference, bad, start);
  const Solution first = test::Solve(Coloured(5), GoodScene());

  Solver undisturbed(Coloured(5));
  (void)test::Solve(&undisturbed, GoodScene());
  const Solution second = test::Solve(&undisturbed, GoodScene(), first.x);

  Solver fresh(Coloured(5)), steady(Coloured(5));
  (void)test::Solve(&steady, GoodScene());
  for (Solver* solver : {&fresh, &steady}) {
    const Report report = Refused(solver, bad, start);
    EXPECT_EQ(report.status, expected.status)
        << Describe(report.status) << ", not " << Describe(expected.status);
    EXPECT_EQ(report.bad_row, expected.bad_row);
    EXPECT_EQ(report.bad_body, expected.bad_body);
  }
  EXPECT_TRUE(test::SameBits(test::Solve(&fresh, GoodScene()), first));
  EXPECT_TRUE(test::SameBits(test::Solve(&steady, GoodScene(), first.x), second));
}

bool IsBound(const std::string& what) { return what.starts_with("lo ") || what.starts_with("hi "); }

TEST(BlockInput, ThatIsNotFiniteIsRefusedAsTheReferenceRefusesIt) {
  for (const Spoiled& spoiled : NotFinite()) {
    Scene scene = GoodScene();
    std::vector<double> start(scene.rows.size(), 0.25);
    spoiled.make(&scene, &start);
    // an infinite bound may be a bound
    if (IsBound(spoiled.what) && test::Solve(test::PlainSweeps(1), scene, start).report.ok()) {
      continue;
    }
    ExpectRefused(spoiled);
  }
}

TEST(BlockInput, ThatIsWrongIsRefusedAsTheReferenceRefusesIt) {
  for (const Spoiled& spoiled : Wrong()) ExpectRefused(spoiled);
}

// A bad frame between two of a game whose contacts begin and end, on threads.
TEST(BlockInput, ThatIsRefusedLeavesNoTraceInAGame) {
  const Scene whole = test::Wall(14, 14);
  for (const int threads : {1, 3}) {
    Settings settings = Coloured(6);
    settings.threads = threads;
    const std::vector<Solution> expected = test::Play(settings, whole, 6);
    test::Game game(whole);
    Solver solver(settings);
    for (const Solution& good : expected) {
      const test::Frame frame = game.Next();
      Scene bad = frame.scene;
      bad.rows.back().target = kNan;
      EXPECT_EQ(Refused(&solver, bad, frame.start).bad_row, static_cast<int>(bad.rows.size()) - 1);
      bad.rows.pop_back();
      bad.bodies.back().inv_mass = -1;
      const std::vector<double> start(frame.start.begin(), frame.start.end() - 1);
      EXPECT_EQ(Refused(&solver, bad, start).status, Status::kBadMass);
      const Solution s = test::Solve(&solver, frame.scene, frame.start);
      EXPECT_TRUE(test::SameBits(s, good));
      game.Take(frame, s);
    }
  }
}

// What floats cannot hold is solved row by row in double precision, as if that had been asked for.
TEST(BlockInput, BeyondTheRangeOfFloatsIsSolvedByTheReference) {
  using Start = std::vector<double>;
  const std::vector<Spoiled> large = {
      {"target", [](Scene* s, Start*) { s->rows[12].target = 1e25; }},
      {"light", [](Scene* s, Start*) { s->bodies[1].inv_mass = 1e30; }},
      {"heavy",
       [](Scene* s, Start*) {
         for (Body& body : s->bodies) {
           body.inv_mass *= 1e-30;
           View(body.inv_inertia) *= 1e-30;
         }
       }},
      {"fast", [](Scene* s, Start*) { s->bodies[1].velocity.linear.z() = -1e22; }},
      {"start", [](Scene*, Start* x) { (*x)[12] = 1e25; }},
      {"friction", [](Scene* s, Start*) { s->rows[13].friction = 1e50; }},
      {"row",
       [](Scene* s, Start*) {
         View(s->rows[12].linear_a) *= 1e20, View(s->rows[12].linear_b) *= 1e20;
       }},
  };
  for (const Spoiled& spoiled : large) {
    SCOPED_TRACE(spoiled.what);
    Scene scene = GoodScene();
    std::vector<double> start(scene.rows.size(), 0.0);
    spoiled.make(&scene, &start);
    Solver fresh(Coloured(20)), steady(Coloured(20)), reference(test::PlainSweeps(20));
    const Solution expected = test::Solve(&reference, scene, start);
    ASSERT_TRUE(expected.report.ok());
    const Solution good = test::Solve(&steady, GoodScene());
    for (Solver* solver : {&fresh, &steady}) {
      EXPECT_TRUE(test::SameBits(test::Solve(solver, scene, start), expected));
      EXPECT_TRUE(test::SameBits(test::Solve(solver, GoodScene()), good));
    }
  }
}

// A contact that is lifted rubs with nothing, by however large a coefficient.
TEST(BlockInput, MayHoldAnyFrictionThatIsFinite) {
  for (const double friction : {1e10, 1e30, 1e50, 1e300}) {
    Scene scene;
    scene.bodies.push_back(test::PointMass(1, {0, 0, 1}));
    scene.bodies[0].velocity.linear = {1, 0, 0};
    scene.rows = {test::PushRow(0, kWorld, {0, 0, 1}), test::LinearRow(0, kWorld, {1, 0, 0})};
    scene.rows[1].parent = 0;
    scene.rows[1].friction = friction;
    const Solution s = test::Solve(Coloured(5), scene);
    ASSERT_TRUE(s.report.ok());
    EXPECT_EQ(s.x, (std::vector<double>{0, 0})) << friction;
    EXPECT_EQ(s.v[0].linear, Eigen::Vector3d(1, 0, 1)) << friction;
  }
}

}  // namespace
}  // namespace cairn
