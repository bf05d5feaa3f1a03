// SPDX-License-Identifier: MIT
// Solvers on recorded frames: they are given what the game solved, and do what they are named for.
#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "cairn/bullet/constraint_solver.h"
#include "cairn/detail/eigen.h"
#include "measure/reference.h"
#include "measure/substep.h"
#include "rows/bullet_row_solver.h"
#include "rows/cairn_row_solver.h"
#include "rows/row_problem.h"
#include "rows/row_solvers.h"
#include "tests/bullet_adapter/scene_world.h"
#include "tests/core/support/test_clock.h"
#include "tests/simd/ask_for.h"

namespace cairn::cli {
namespace {

using test::SceneWorld;
using testing::HasSubstr;

/// Bullet's default solver, which keeps what it is asked in one substep.
class CapturingSolver : public btSequentialImpulseConstraintSolver {
 public:
  void CaptureNext(bench::Substep* substep) { substep_ = substep; }

  void prepareSolve(int bodies, int manifolds) override {
    if (substep_ != nullptr) substep_->Begin(bodies, manifolds);
  }
  btScalar solveGroup(btCollisionObject** bodies, int num_bodies, btPersistentManifold** manifolds,
                      int num_manifolds, btTypedConstraint** joints, int num_joints,
                      const btContactSolverInfo& info, btIDebugDraw* draw,
                      btDispatcher* dispatcher) override {
    if (substep_ == nullptr) {
      return btSequentialImpulseConstraintSolver::solveGroup(
          bodies, num_bodies, manifolds, num_manifolds, joints, num_joints, info, draw, dispatcher);
    }
    substep_->Add({{bodies, bodies + num_bodies},
                   {manifolds, manifolds + num_manifolds},
                   {joints, joints + num_joints}},
                  dispatcher);
    return 0;
  }
  void allSolved(const btContactSolverInfo& info, btIDebugDraw*) override {
    if (substep_ == nullptr) return;
    substep_->Capture();
    info_ = info;
    substep_ = nullptr;
  }
  const btContactSolverInfo& info() const { return info_; }

 private:
  bench::Substep* substep_ = nullptr;
  btContactSolverInfo info_;
};

/// No tolerance: as many sweeps as are asked for.
LcpOptions CountedOptions() { return {.tolerance = 0, .max_sweeps = {}, .budget = {}}; }

RowOutcome Solve(RowSolver* solver, const RowProblem& problem, int iterations) {
  EXPECT_EQ(solver->Prepare(problem), "");
  solver->IterateUntil({.iterations = iterations, .time = {}});
  return solver->Result();
}

/// For names of files, as tests run side by side.
std::string NameOfTest() {
  std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

/// A frame of a scene: as Bullet holds it, and recorded.
class Frame {
 public:
  Frame(std::string_view scene, int number, bullet::Mode mode = bullet::Mode::kFast)
      : world_(scene, &capturing_) {
    world_.Step(number);
    capturing_.CaptureNext(&substep_);
    world_.Step(1);
    path_ = testing::TempDir() + "/frame" + std::to_string(8 * sizeof(btScalar)) + "_" +
            NameOfTest() + "_" + std::string(scene) + std::to_string(number) + ".cairn";
    bullet::Options options{.mode = mode};
    options.warm_start_friction = options.warm_start_joints = false;
    options.two_friction_directions = false;  // as Bullet's
    bullet::ConstraintSolver recording({}, options);
    recording.RecordNext(path_);
    world_.world().bullet()->applyGravity();  // the step is over, and forces are cleared
    substep_.Restore();
    substep_.SolveWith(&recording, capturing_.info(), nullptr);
    EXPECT_EQ(recording.recorded().last_file, path_) << recording.recorded().last_failure;
  }
  ~Frame() { std::filesystem::remove(path_); }
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  std::shared_ptr<const RowProblem> problem() const { return LoadRowProblem(path_); }
  /// What a solver of Bullet's adds to the velocities of all bodies, gravity left out.
  std::vector<Velocity> SolveInWorld(btConstraintSolver* solver, int iterations) {
    btContactSolverInfo info = capturing_.info();
    info.m_numIterations = iterations;
    substep_.Restore();
    std::vector<Velocity> before = bench::ReadVelocities(substep_.bodies());
    substep_.SolveWith(solver, info, nullptr);
    std::vector<Velocity> after = bench::ReadVelocities(substep_.bodies());
    for (size_t i = 0; i < after.size(); ++i) {
      View(after[i].linear) -= View(before[i].linear) + Fall(*substep_.bodies()[i]);
    }
    return after;
  }
  /// The largest of these [m/s].
  double Change(btConstraintSolver* in_world, int iterations) {
    double largest = 0;
    for (const Velocity& velocity : SolveInWorld(in_world, iterations)) {
      largest = std::max(largest, View(velocity.linear).norm());
    }
    return largest;
  }

  /// The largest difference to what a solver adds on the rows [m/s].
  double Difference(btConstraintSolver* in_world, RowSolver* on_rows, int iterations,
                    int iterations_on_rows = 0) {
    const auto recorded = problem();
    const std::vector<Velocity> expected = SolveInWorld(in_world, iterations);
    const RowOutcome outcome = Solve(on_rows, *recorded, std::max(iterations, iterations_on_rows));
    std::vector<Velocity> found;  // of those that move: Bullet's rows have a body for all others
    for (size_t i = 0; i < outcome.velocities.size(); ++i) {
      if (recorded->rows.bodies[i].inv_mass > 0) found.push_back(outcome.velocities[i]);
    }
    EXPECT_EQ(found.size(), expected.size());
    if (found.size() != expected.size()) return kInfinity;
    return bench::VelocityError(expected, found);
  }

 private:
  /// What gravity adds in a step.
  Eigen::Vector3d Fall(const btRigidBody& body) const {
    const btVector3 fall =
        body.getTotalForce() * (body.getInvMass() * capturing_.info().m_timeStep);
    return {fall.x(), fall.y(), fall.z()};
  }

  CapturingSolver capturing_;
  SceneWorld world_;
  bench::Substep substep_;
  std::string path_;
};

/// Of what a substep changes: both sides round the numbers of a row to float, and not in the same
/// order.
constexpr double kRounding = 1e-5;

class SweptFrame : public testing::TestWithParam<std::tuple<std::string_view, bullet::Mode>> {
 protected:
  Frame At(int number) const {
    return Frame(std::get<0>(GetParam()), number, std::get<1>(GetParam()));
  }
};

TEST_P(SweptFrame, IsSweptOverAsBulletSweepsInTheWorld) {
  for (const int number : {20, 40}) {
    Frame frame = At(number);
    btSequentialImpulseConstraintSolver in_world;
    BulletRowSolver<btSequentialImpulseConstraintSolver> on_rows;
    for (const int iterations : {1, 10, 50}) {
      const double change = frame.Change(&in_world, iterations);
      EXPECT_GT(change, 0.05);
      EXPECT_LE(frame.Difference(&in_world, &on_rows, iterations), kRounding * (1 + change))
          << "frame " << number << ", " << iterations << " iterations";
      // one sweep more is not the same
      EXPECT_GT(frame.Difference(&in_world, &on_rows, iterations, iterations + 1),
                10 * kRounding * (1 + change));
    }
  }
}

TEST_P(SweptFrame, IsSolvedByBulletsNncgAsInTheWorld) {
  Frame frame = At(20);
  btNNCGConstraintSolver in_world;
  in_world.m_onlyForNoneContact = false;
  BulletRowSolver<btNNCGConstraintSolver> on_rows;
  // On ragdolls it has no bounds, and what differs by rounding soon differs by metres per second.
  for (const int iterations : {1, 5}) {
    const double change = frame.Change(&in_world, iterations);
    EXPECT_LE(frame.Difference(&in_world, &on_rows, iterations), kRounding * (1 + change));
  }
}

constexpr std::string_view kScenes[] = {"tower", "chain", "ragdolls", "wall"};

INSTANTIATE_TEST_SUITE_P(InBulletsRows, SweptFrame,
                         testing::Combine(testing::ValuesIn(kScenes),
                                          testing::Values(bullet::Mode::kReference)));
#ifndef BT_USE_DOUBLE_PRECISION
// With a Bullet of doubles, points that slide slower than floats can tell have other directions of
// friction in manifolds than Bullet gives them.
INSTANTIATE_TEST_SUITE_P(InManifolds, SweptFrame,
                         testing::Combine(testing::ValuesIn(kScenes),
                                          testing::Values(bullet::Mode::kFast)));
#endif

class RecordedFrame : public testing::TestWithParam<std::string_view> {};

TEST_P(RecordedFrame, HasTheSameBitsOnEveryInstructionSet) {
  Frame frame(GetParam(), 40);
  const auto problem = frame.problem();
  for (const RowSolverEntry& entry : RowSolvers()) {
    std::vector<double> expected;
    for (const simd::Target target : simd::SupportedTargets()) {
      const test::AskFor asked(target);
      const auto solver = entry.make(CountedOptions());
      if (!solver->Prepare(*problem).empty()) continue;
      const RowOutcome outcome = Solve(solver.get(), *problem, 20);
      EXPECT_NE(outcome.impulses, problem->rows.row_impulses) << entry.name;
      if (expected.empty()) expected = outcome.impulses;
      EXPECT_TRUE(outcome.impulses == expected) << entry.name << " " << simd::TargetName(target);
    }
  }
}

TEST_P(RecordedFrame, IsSolvedAnewEachTime) {
  Frame frame(GetParam(), 40);
  const auto problem = frame.problem();
  for (const RowSolverEntry& entry : RowSolvers()) {
    const auto solver = entry.make(CountedOptions());
    if (!solver->Prepare(*problem).empty()) continue;
    const RowOutcome first = Solve(solver.get(), *problem, 30);
    Solve(solver.get(), *problem, 10);
    EXPECT_TRUE(Solve(solver.get(), *problem, 30).impulses == first.impulses) << entry.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Every, RecordedFrame, testing::ValuesIn(kScenes));

// A frame recorded without a budget bounds its rows to the iterations of the game: a solver that
// kept to that would end after ten sweeps, with time left and hardly a step.
TEST(RowProblem, LetsSolversGoAsFarAsTheBudget) {
  for (const std::string_view scene : {"tower", "wall"}) {
    Frame frame(scene, 40);
    const auto problem = frame.problem();
    EXPECT_EQ(problem->limited_sweeps, 0);  // only overrides of joints limit rows
    CairnRowSolver solver(Method::kPgsSm, CountedOptions());
    for (int time = 0; time < 2; ++time) {
      ASSERT_EQ(solver.Prepare(*problem), "");
      const test::ScriptedClock clock = test::TickingClock(std::chrono::microseconds(20));
      solver.IterateUntil(
          {.iterations = {}, .time = std::chrono::milliseconds(40), .clock = &clock});
      const RowOutcome outcome = solver.Result();
      EXPECT_GT(outcome.steps_accepted, 0) << scene << ", time " << time;
      EXPECT_GT(outcome.iterations, 30) << scene;
      EXPECT_EQ(outcome.stop, "budget spent");
    }
  }
}

TEST(RowProblem, StartsFromWhatWasRecordedOrFromNothing) {
  Frame frame("tower", 40);
  const auto problem = frame.problem();
  const auto is_zero = [](double impulse) { return impulse == 0; };
  EXPECT_FALSE(
      std::all_of(problem->rows.row_impulses.begin(), problem->rows.row_impulses.end(), is_zero));
  const RowProblem from_zero = FromZero(*problem);
  EXPECT_TRUE(
      std::all_of(from_zero.rows.row_impulses.begin(), from_zero.rows.row_impulses.end(), is_zero));
  CairnRowSolver solver(Method::kPgs, CountedOptions());
  EXPECT_FALSE(Solve(&solver, *problem, 3).impulses == Solve(&solver, from_zero, 3).impulses);
}

double ResidualOf(const RowOutcome& outcome, const RowProblem& problem) {
  return cairn::Measure(problem.rows.problem(), outcome.impulses).residual_max;
}

TEST(RowSolvers, AllComeToTheSameChain) {
  Frame frame("chain", 40);
  const auto problem = frame.problem();
  const double before =
      cairn::Measure(problem->rows.problem(), problem->rows.row_impulses).residual_max;
  for (const RowSolverEntry& entry : RowSolvers()) {
    const RowOutcome outcome = Solve(entry.make(CountedOptions()).get(), *problem, 3000);
    EXPECT_EQ(outcome.failure, "") << entry.name;
    // Dantzig's has a compliance that Bullet's examples give it
    const double share = entry.name == "bullet-dantzig" ? 0.2 : 0.02;
    EXPECT_LT(ResidualOf(outcome, *problem), share * before) << entry.name;
  }
}

TEST(RowSolvers, SayWhatTheyCannotSolve) {
  Frame tower("tower", 40), wall("wall", 40);
  const auto refusal = [](std::string_view name, const RowProblem& problem) {
    for (const RowSolverEntry& entry : RowSolvers()) {
      if (entry.name == name) return entry.make(CountedOptions())->Prepare(problem);
    }
    return std::string("no such solver");
  };
  EXPECT_THAT(refusal("ipm", *tower.problem()), HasSubstr("friction"));
  EXPECT_EQ(refusal("bullet-dantzig", *tower.problem()), "");
  EXPECT_THAT(refusal("bullet-dantzig", *wall.problem()), HasSubstr(" rows: dense"));
  EXPECT_THAT(refusal("bullet-pgs-mlcp", *wall.problem()), HasSubstr(" rows: dense"));

  RowProblem bounded = *tower.problem();
  bounded.rows.rows[0].hi = 1;
  EXPECT_THAT(refusal("bullet-si", bounded), HasSubstr("row 0: a contact has an upper bound"));
}

TEST(RowSolvers, EndWhenTheirTimeIsUp) {
  Frame frame("tower", 40);
  const auto problem = frame.problem();
  for (const std::string_view name : {"pgs", "bullet-si", "bullet-nncg", "bullet-pgs-mlcp"}) {
    for (const RowSolverEntry& entry : RowSolvers()) {
      if (entry.name != name) continue;
      const auto solver = entry.make(CountedOptions());
      int last = 0;
      for (const int microseconds : {1, 1000, 8000}) {
        ASSERT_EQ(solver->Prepare(*problem), "");
        const test::ScriptedClock clock = test::TickingClock(std::chrono::microseconds(50));
        RowLimit limit{.iterations = {}, .time = std::chrono::microseconds(microseconds)};
        // this one doubles its effort from look to look, by what that took: by the true clock
        const bool scripted = name != "bullet-pgs-mlcp";
        if (scripted) limit.clock = &clock;
        solver->IterateUntil(limit);
        const int iterations = solver->Result().iterations;
        EXPECT_GT(iterations, scripted ? last : 0) << name;
        last = iterations;
      }
    }
  }
}

}  // namespace
}  // namespace cairn::cli
