// SPDX-License-Identifier: MIT
// What holds for every problem. RapidCheck chooses the problems, from a fixed seed unless
// RC_PARAMS says otherwise.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "cairn/detail/eigen.h"
#include "tests/core/support/dense.h"
#include "tests/core/support/problems.h"

namespace cairn {
namespace {

using test::Scene;
using test::Solution;

const bool kSeeded = setenv("RC_PARAMS", "seed=20240607", /*overwrite=*/0) == 0;

Scene AnyScene() {
  const test::PileOptions options{.bodies = *rc::gen::inRange(2, 12),
                                  .contacts = *rc::gen::inRange(0, 25),
                                  .pins = *rc::gen::inRange(0, 6),
                                  .world_share = *rc::gen::inRange(0, 5) / 4.0};
  return test::RandomPile(options, *rc::gen::inRange<std::uint64_t>(0, 1'000'000));
}

Settings AnySettings() {
  Settings settings;
  settings.method = *rc::gen::element(Method::kPgs, Method::kPsor, Method::kPgsSm);
  settings.path = *rc::gen::element(Path::kAuto, Path::kReference);
  settings.tuning.omega = *rc::gen::element(0.5, 1.0, 1.5);
  settings.k_gs = *rc::gen::inRange(1, 8);
  settings.k_sm = *rc::gen::inRange(0, 4);
  settings.max_sweeps = *rc::gen::inRange(0, 60);
  settings.tolerance = *rc::gen::element(0.0, 1e-6, 1e-3);
  settings.step_policy = *rc::gen::element(StepPolicy::kMeasured, StepPolicy::kAlways);
  settings.tuning.refinements = *rc::gen::inRange(1, 4);
  settings.budget = *rc::gen::element(Budget::Unlimited(), Budget::Work(500), Budget::Work(5000));
  return settings;
}

std::vector<double> AnyStart(const Scene& scene) {
  test::Random random(*rc::gen::inRange<std::uint64_t>(0, 1'000'000));
  std::vector<double> start(scene.rows.size());
  for (double& x : start) x = random.Uniform(-1, 1);
  return start;
}

RC_GTEST_PROP(EveryProblem, EndsInsideItsBounds, ()) {
  const Scene scene = AnyScene();
  const Settings settings = AnySettings();
  const Solution s = test::Solve(settings, scene, AnyStart(scene));
  RC_ASSERT(s.report.ok());
  // a coefficient, an impulse and their product are rounded where sweeps are made in floats
  const double rounding = settings.path == Path::kReference ? 0 : 0x1p-22;
  const Eigen::VectorXd x = test::ToVector(s.x);
  for (int i = 0; i < x.size(); ++i) {
    RC_ASSERT(std::abs(x[i] - test::Project(scene, x, i, x[i])) <= rounding * std::abs(x[i]));
  }
}

// The solver adds up changes of velocity over up to 60 sweeps of 90 rows, at speeds of up to 100: a
// float is wrong by up to 6e-6 each time, in any direction.
RC_GTEST_PROP(EveryProblem, EndsWithTheVelocitiesOfItsImpulses, ()) {
  const Scene scene = AnyScene();
  const test::Dense dense = test::MakeDense(scene);
  const Settings settings = AnySettings();
  const Solution s = test::Solve(settings, scene, AnyStart(scene));
  const double tolerance = settings.path == Path::kReference ? 1e-10 : 1e-3;
  const Eigen::VectorXd v =
      dense.free + dense.inverse_mass * (dense.J.transpose() * test::ToVector(s.x));
  RC_ASSERT((test::Flatten(s.v) - v).cwiseAbs().maxCoeff() < tolerance);
}

RC_GTEST_PROP(EveryProblem, GivesItsBitsAgain, ()) {
  const Scene scene = AnyScene();
  const Settings settings = AnySettings();
  const std::vector<double> start = AnyStart(scene);
  const Solution first = test::Solve(settings, scene, start);
  RC_ASSERT(bool(test::SameBits(first, test::Solve(settings, scene, start))));

  // and from a solver that has seen it and another one
  Solver used(settings);
  (void)test::Solve(&used, scene, start);
  (void)test::Solve(&used, AnyScene());
  used.Reset();
  RC_ASSERT(bool(test::SameBits(first, test::Solve(&used, scene, start))));
}

/// Everything heavier: masses, impulses and stiffness times @p s.
Scene Heavier(Scene scene, double s) {
  for (Body& body : scene.bodies) {
    body.inv_mass /= s;
    View(body.inv_inertia) /= s;
    View(body.impulse) *= s;
    View(body.angular_impulse) *= s;
  }
  for (Row& row : scene.rows) row.compliance /= s;
  return scene;
}

// Powers of 4 are exact, and so are their roots: not a bit changes, whatever is decided on the way.
RC_GTEST_PROP(EveryProblem, MovesTheSameWayWhenEverythingIsHeavier, ()) {
  const Scene scene = AnyScene();
  const double s = *rc::gen::element(0.0625, 4.0, 1024.0);
  const Settings settings = AnySettings();
  Solution light = test::Solve(settings, scene);
  const Solution heavy = test::Solve(settings, Heavier(scene, s));
  for (double& x : light.x) x *= s;
  RC_ASSERT(bool(test::SameBits(light, heavy)));
}

RC_GTEST_PROP(EveryProblem, MovesTheSameWayWhenEverythingIsHeavierByAnyFactor, ()) {
  const Scene scene = AnyScene();
  const double s = *rc::gen::element(0.01, 3.0, 777.0);
  const Solution light = test::Solve(test::PlainSweeps(20), scene);
  const Solution heavy = test::Solve(test::PlainSweeps(20), Heavier(scene, s));
  RC_ASSERT(test::Distance(light.v, heavy.v) < 1e-10);
  const Eigen::VectorXd x = s * test::ToVector(light.x);
  RC_ASSERT((x - test::ToVector(heavy.x)).norm() <= 1e-10 * x.norm());
}

/// Body i becomes body order[i].
Scene Permuted(const Scene& scene, const std::vector<int>& order) {
  Scene permuted = scene;
  for (size_t i = 0; i < order.size(); ++i) permuted.bodies[order[i]] = scene.bodies[i];
  for (Row& row : permuted.rows) {
    if (row.body_a != kWorld) row.body_a = order[row.body_a];
    if (row.body_b != kWorld) row.body_b = order[row.body_b];
  }
  return permuted;
}

std::vector<int> AnyOrder(const Scene& scene) {
  std::vector<int> order(scene.bodies.size());
  std::iota(order.begin(), order.end(), 0);
  test::Random random(*rc::gen::inRange<std::uint64_t>(0, 1'000'000));
  for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.Index(i)]);
  return order;
}

Solution PutBack(Solution solution, const std::vector<int>& order) {
  const std::vector<Velocity> v = solution.v;
  for (size_t i = 0; i < order.size(); ++i) solution.v[i] = v[order[i]];
  return solution;
}

// Sweeps follow the rows: the order of bodies is not seen, to the bit.
RC_GTEST_PROP(EveryProblem, DoesNotSeeTheOrderOfItsBodies, ()) {
  const Scene scene = AnyScene();
  const std::vector<int> order = AnyOrder(scene);
  Settings settings = AnySettings();
  settings.k_sm = 0;
  settings.budget = Budget::Unlimited();
  const Solution permuted = test::Solve(settings, Permuted(scene, order));
  RC_ASSERT(bool(test::SameBits(test::Solve(settings, scene), PutBack(permuted, order))));
}

// Steps eliminate bodies in another order: another rounding, magnified by 1 / proximal.
RC_GTEST_PROP(EveryProblem, TakesTheSameStepsInAnyOrderOfItsBodies, ()) {
  const Scene scene = test::HangingChain(*rc::gen::inRange(2, 15), *rc::gen::element(1.0, 50.0));
  const std::vector<int> order = AnyOrder(scene);
  const Solution straight = test::Solve(test::AlwaysSteps(20), scene);
  const Solution permuted = test::Solve(test::AlwaysSteps(20), Permuted(scene, order));
  RC_ASSERT(straight.report.factorisations == permuted.report.factorisations);
  RC_ASSERT(test::Distance(straight.v, PutBack(permuted, order).v) < 1e-7);
}

// The other island comes first, so that everything has another number.
RC_GTEST_PROP(EveryProblem, DoesNotSeeAnIslandThatItDoesNotTouch, ()) {
  const Scene scene = AnyScene();
  Settings settings = AnySettings();
  settings.budget = Budget::Unlimited();
  Scene more = test::Tower(3);
  const int bodies = 3, rows = 36;
  more.bodies.insert(more.bodies.end(), scene.bodies.begin(), scene.bodies.end());
  for (Row row : scene.rows) {
    if (row.body_a != kWorld) row.body_a += bodies;
    if (row.body_b != kWorld) row.body_b += bodies;
    if (row.parent != kNoRow) row.parent += rows;
    more.rows.push_back(row);
  }
  Solution s = test::Solve(settings, more);
  s.x.erase(s.x.begin(), s.x.begin() + rows);
  s.v.erase(s.v.begin(), s.v.begin() + bodies);
  RC_ASSERT(bool(test::SameBits(s, test::Solve(settings, scene))));
}

}  // namespace
}  // namespace cairn
