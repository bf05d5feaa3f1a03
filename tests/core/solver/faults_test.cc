// SPDX-License-Identifier: MIT
// What a host may do to a solver: memory that ends at any allocation, and executors that throw, run
// late, run never, or run what they should not. After an exception a solver is as new.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "cairn/detail/eigen.h"
#include "cairn/lcp/solver.h"
#include "tests/core/support/block_problems.h"
#include "tests/core/support/counting_memory.h"
#include "tests/core/support/manifold_problems.h"
#include "tests/core/support/test_clock.h"
#include "tests/core/support/watched_new.h"

namespace cairn {
namespace {

using test::FailNewAfter;
using test::ManifoldScene;
using test::SameBits;

/// What a frame writes.
struct Written {
  std::vector<double> rows;
  std::vector<ContactImpulse> points;
  std::vector<float> joint_rows;
  std::vector<Velocity> velocities;

  friend bool operator==(const Written& a, const Written& b) {
    const auto same = [](const Velocity& v, const Velocity& w) {
      return v.linear == w.linear && v.angular == w.angular;
    };
    return a.rows == b.rows && SameBits(a.points, b.points) && a.joint_rows == b.joint_rows &&
           std::ranges::equal(a.velocities, b.velocities, same);
  }
};

Written Solve(Solver* solver, ManifoldScene scene) {
  Written written;
  written.velocities.resize(scene.bodies.size());
  const Report report = solver->Solve(scene.problem(), scene.impulses(), written.velocities);
  EXPECT_TRUE(report.ok());
  written.rows = scene.row_impulses;
  written.points = scene.point_impulses;
  written.joint_rows = scene.joint_impulses;
  return written;
}

/// Frames that grow, change and shrink, of rows, joints and manifolds.
std::vector<ManifoldScene> Frames() {
  std::vector<ManifoldScene> frames;
  const int sizes[] = {3, 8, 8, 5};
  for (int size : sizes) {
    ManifoldScene& scene = frames.emplace_back(test::RandomManifolds(size, 2 * size, size));
    test::AddJoints(size, size, &scene);
    scene.rows = test::RandomPile({.bodies = size, .contacts = size, .pins = 1}, size).rows;
    scene.row_impulses.assign(scene.rows.size(), 0.1);
  }
  frames.push_back(test::ManifoldTower(4));
  frames.push_back(frames[1]);
  return frames;
}

/// Where memory ends, and when: operator new, or a memory of one's own.
struct EndOfMemory {
  test::CountingMemory* memory = nullptr;
  long call = -1;  ///< that fails; none below 0

  void Begin() const { memory != nullptr ? memory->FailAfter(call) : FailNewAfter(call); }
  void End() const { memory != nullptr ? memory->FailAfter(-1) : FailNewAfter(-1); }
};

/// Solves a frame with one allocation that fails, if it gets that far. An exception leaves the
/// outputs as they were.
bool Survives(Solver* solver, ManifoldScene scene, const EndOfMemory& failure) {
  std::vector<Velocity> velocities(scene.bodies.size());
  for (Velocity& velocity : velocities) View(velocity.linear).setConstant(7);
  const ManifoldScene before = scene;
  Report report;
  try {
    failure.Begin();
    solver->Solve(scene.problem(), scene.impulses(), velocities, &report);
    failure.End();
    EXPECT_TRUE(report.ok());
    return true;
  } catch (const std::bad_alloc&) {
    failure.End();
  }
  EXPECT_EQ(scene.row_impulses, before.row_impulses);
  EXPECT_EQ(scene.joint_impulses, before.joint_impulses);
  EXPECT_TRUE(SameBits(scene.point_impulses, before.point_impulses));
  for (const Velocity& velocity : velocities) EXPECT_EQ(velocity.linear.x(), 7);
  return false;
}

void FailEverywhere(const Settings& settings, test::CountingMemory* memory = nullptr) {
  const std::vector<ManifoldScene> frames = Frames();
  int failures = 0;
  for (size_t failing = 0; failing < frames.size(); ++failing) {
    for (long call = 0;; ++call) {
      Solver solver(settings, memory), fresh(settings);
      for (size_t i = 0; i < failing; ++i) Solve(&solver, frames[i]);
      if (Survives(&solver, frames[failing], {memory, call})) break;
      ++failures;
      for (size_t i = failing; i < frames.size(); ++i) {
        ASSERT_TRUE(Solve(&solver, frames[i]) == Solve(&fresh, frames[i]))
            << "allocation " << call << " of frame " << failing << ", then frame " << i;
      }
    }
  }
  EXPECT_GT(failures, 50);
}

TEST(NoMemory, LeavesASolverOfBlocksAsNew) {
  FailEverywhere({.max_sweeps = 20, .tolerance = 0, .step_policy = StepPolicy::kAlways});
}

TEST(NoMemory, OfOnesOwnLeavesASolverAsNew) {
  for (const Path path : {Path::kFast, Path::kReference}) {
    test::CountingMemory memory;
    FailEverywhere(
        {.path = path, .max_sweeps = 12, .tolerance = 0, .step_policy = StepPolicy::kAlways},
        &memory);
    EXPECT_EQ(memory.blocks(), 0);
  }
}

TEST(NoMemory, OfOnesOwnLeavesASolverOfPartsAsNew) {
  test::CountingMemory memory;
  memory.FailByThrowing();
  FailEverywhere({.max_sweeps = 4, .substeps = 2, .relax = true, .tolerance = 0}, &memory);
  EXPECT_EQ(memory.blocks(), 0);
}

TEST(NoMemory, LeavesASolverUnderABudgetOfTimeAsNew) {
  const test::ScriptedClock clock = test::TickingClock(std::chrono::microseconds(10));
  FailEverywhere({.tolerance = 0,
                  .budget = Budget::Time(std::chrono::microseconds(300)),
                  .step_policy = StepPolicy::kAlways,
                  .tuning = {.clock = &clock}});
}

TEST(NoMemory, LeavesASolverOfRowsAsNew) {
  FailEverywhere({.path = Path::kReference, .max_sweeps = 12, .tolerance = 0});
}

TEST(NoMemory, LeavesASolverOfMatricesAsNew) {
  lcp::BoxedLcp problem;
  const int size = 12;
  problem.M.resize(size, size);
  for (int i = 0; i < size; ++i) {
    for (int j = std::max(0, i - 2); j <= std::min(size - 1, i + 2); ++j) {
      problem.M.insert(i, j) = i == j ? 4.0 : -0.5;
    }
  }
  problem.q = Eigen::VectorXd::LinSpaced(size, -3, 2);
  problem.lo = Eigen::VectorXd::Zero(size);
  problem.hi = Eigen::VectorXd::Constant(size, kInfinity);
  const Eigen::VectorXd start = Eigen::VectorXd::Ones(size);
  for (lcp::Method method : {lcp::Method::kPgs, lcp::Method::kPgsSm, lcp::Method::kInteriorPoint}) {
    Eigen::VectorXd expected = start;
    (void)lcp::Solver({.method = method}).Solve(problem, &expected);
    for (long call = 0;; ++call) {
      lcp::Solver solver({.method = method});
      Eigen::VectorXd x = start;
      bool threw = false;
      try {
        FailNewAfter(call);
        (void)solver.Solve(problem, &x);
        FailNewAfter(-1);
      } catch (const std::bad_alloc&) {
        FailNewAfter(-1);
        threw = true;
        EXPECT_EQ(x, start);
      }
      x = start;
      EXPECT_TRUE(solver.Solve(problem, &x).ok());
      EXPECT_EQ(x, expected);
      if (!threw) break;
    }
  }
}

/// Enough rows to be worth threads.
ManifoldScene LargeScene() { return test::ManifoldTower(600); }

Settings OnThreads(Executor* executor) {
  return {.max_sweeps = 4, .tolerance = 0, .threads = 3, .executor = executor};
}

/// What a tower comes out as without any executor.
Written Expected() {
  Solver alone(OnThreads(nullptr));
  alone.settings().threads = 1;
  return Solve(&alone, LargeScene());
}

// Whoever does what needs memory: nobody is at work any more when the caller hears of it.
TEST(NoMemory, LeavesASolverOnSeveralThreadsAsNew) {
  // so large that helpers are there when the plan is made
  const ManifoldScene scene = test::ManifoldTower(8000);
  Solver alone(OnThreads(nullptr));
  alone.settings().threads = 1;
  const Written expected = Solve(&alone, scene);
  for (long call = 0;; ++call) {
    test::CountingMemory memory;
    Solver solver(OnThreads(nullptr), &memory);
    if (Survives(&solver, scene, {&memory, call})) {
      EXPECT_GT(call, 50);
      break;
    }
    ASSERT_TRUE(Solve(&solver, scene) == expected) << "allocation " << call;
  }
}

class ThrowingExecutor final : public Executor {
 public:
  explicit ThrowingExecutor(int good) : good_(good) {}
  ~ThrowingExecutor() override {
    for (std::thread& thread : threads_) thread.join();
  }
  void Submit(void (*work)(void*), void* what) override {
    if (good_-- == 0) throw std::runtime_error("no more tasks");
    threads_.emplace_back(work, what);
  }

 private:
  int good_;
  std::vector<std::thread> threads_;
};

TEST(BadExecutor, ThatThrowsIsHeardAndLeavesTheSolverAsNew) {
  const Written expected = Expected();
  for (int good : {0, 1}) {
    ThrowingExecutor executor(good);
    Solver solver(OnThreads(&executor));
    EXPECT_THROW(Solve(&solver, LargeScene()), std::runtime_error);
    solver.settings().executor = nullptr;
    EXPECT_TRUE(Solve(&solver, LargeScene()) == expected);
  }
}

/// Keeps tasks until it is told to run them.
class KeepingExecutor final : public Executor {
 public:
  void Submit(void (*work)(void*), void* what) override { tasks.emplace_back(work, what); }
  void RunAll() {
    for (const auto& [work, what] : tasks) std::thread(work, what).join();
  }
  std::vector<std::pair<void (*)(void*), void*>> tasks;
};

TEST(BadExecutor, ThatRunsNeverOrLateIsNotWaitedFor) {
  const Written expected = Expected();
  KeepingExecutor executor;
  {
    Solver solver(OnThreads(&executor));
    for (int frame = 0; frame < 3; ++frame) {
      EXPECT_TRUE(Solve(&solver, LargeScene()) == expected);
    }
    EXPECT_EQ(executor.tasks.size(), 2u);  // those who never came are still expected
  }
  executor.RunAll();  // the solver is gone
}

TEST(BadExecutor, ThatRunsATaskTwiceDoesNoHarmWhileTheSolverLives) {
  const Written expected = Expected();
  KeepingExecutor executor;
  Solver solver(OnThreads(&executor));
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_TRUE(Solve(&solver, LargeScene()) == expected);
    executor.RunAll();
    executor.RunAll();
    executor.tasks.clear();
  }
}

/// Runs tasks where it should not: on the thread that waits for them.
class ImmediateExecutor final : public Executor {
 public:
  void Submit(void (*work)(void*), void* what) override { work(what); }
};

TEST(BadExecutor, ThatRunsOnTheCallersThreadReturnsAtOnce) {
  ImmediateExecutor executor;
  Solver solver(OnThreads(&executor));
  EXPECT_TRUE(Solve(&solver, LargeScene()) == Expected());
}

}  // namespace
}  // namespace cairn
