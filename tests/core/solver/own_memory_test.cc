// SPDX-License-Identifier: MIT
// Memory of a game's own: all that a solver keeps lies in it, is counted, and comes back. This
// program has an operator new that counts.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "cairn/cairn.h"
#include "cairn/joints.h"
#include "tests/c/c_problems.h"
#include "tests/core/support/block_problems.h"
#include "tests/core/support/counting_memory.h"
#include "tests/core/support/watched_new.h"

namespace cairn {
namespace {

using test::CountingMemory;
using test::ManifoldScene;

/// One thread beside the caller's, which takes no memory for its tasks.
class OneThread final : public Executor {
 public:
  ~OneThread() override {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  void Submit(void (*work)(void*), void* what) override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return work_ == nullptr; });
    work_ = work;
    what_ = what;
    ++tasks_;
    changed_.notify_all();
  }
  /// Until all tasks were run.
  void Wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return work_ == nullptr && !busy_; });
  }
  int tasks() const { return tasks_; }

 private:
  void Run() {
    for (std::unique_lock lock(mutex_);;) {
      changed_.wait(lock, [this] { return ends_ || work_ != nullptr; });
      if (work_ == nullptr) return;
      void (*const work)(void*) = std::exchange(work_, nullptr);
      busy_ = true;
      lock.unlock();
      changed_.notify_all();
      work(what_);
      lock.lock();
      busy_ = false;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  void (*work_)(void*) = nullptr;
  void* what_ = nullptr;
  int tasks_ = 0;
  bool ends_ = false, busy_ = false;
  std::thread thread_{[this] { Run(); }};
};

/// Frames of a game that grows, changes and shrinks, of rows, joints and manifolds, in turn.
class Life {
 public:
  Life() {
    for (const int size : {3, 9, 30, 30, 8, 40, 5}) {
      ManifoldScene& scene = frames_.emplace_back(test::RandomManifolds(size, 2 * size, size));
      test::AddJoints(size, size, &scene);
      scene.rows = test::RandomPile({.bodies = size, .contacts = size, .pins = 1}, size).rows;
      scene.row_impulses.assign(scene.rows.size(), 0.1);
      scene.motions.clear();
    }
    frames_.push_back(test::ManifoldTower(600));  // worth threads
    frames_.push_back(test::ManifoldTower(12));
    report_.islands.reserve(2000);  // the report is ours, and so is its memory
    report_.island_of.reserve(2000);
    report_.replay.fits.reserve(10000);
  }

  /// Solves one frame; each has other settings, too.
  void Frame(Solver* solver) {
    const int turn = frame_ / static_cast<int>(frames_.size());
    ManifoldScene scene = frames_[frame_++ % frames_.size()];
    std::vector<Velocity> velocities(scene.bodies.size());
    Settings& settings = solver->settings();
    settings.path = turn % 8 == 7 ? Path::kReference : Path::kFast;
    settings.substeps = turn % 4 == 1 ? 3 : 1;
    settings.relax = turn % 4 == 2;
    settings.budget = turn % 5 == 4 ? some_budget : Budget::Unlimited();
    settings.steps = turn % 2 == 0 || turn % 8 == 1;
    settings.step_policy = turn % 3 == 0 ? StepPolicy::kAlways : StepPolicy::kMeasured;
    ContactProblem problem = scene.problem();
    problem.time_step = 1 / 60.0;
    const long before = test::NewCalls(), before_past = test::NewCallsPastMemory();
    solver->Solve(problem, scene.impulses(), velocities, &report_);
    // Eigen orders a new graph in memory of its own, for the moment
    elsewhere_ +=
        settings.steps ? test::NewCallsPastMemory() - before_past : test::NewCalls() - before;
    ASSERT_TRUE(report_.ok()) << Describe(report_);
    steps_ += report_.steps_accepted;
    for (const Velocity& velocity : velocities) sum_ += velocity.linear.x() + velocity.angular.y();
  }

  Budget some_budget = Budget::Work(50'000);  ///< of some frames

  long elsewhere() const { return elsewhere_; }  ///< calls of operator new by Solve()
  int steps() const { return steps_; }
  double sum() const { return sum_; }  ///< of what came out

 private:
  std::vector<ManifoldScene> frames_;
  Report report_;
  int frame_ = 0, steps_ = 0;
  long elsewhere_ = 0;
  double sum_ = 0;
};

constexpr Settings kSettings = {.max_sweeps = 12, .tolerance = 0};

TEST(OwnMemory, HoldsAllOfALifeOfThreeHundredFrames) {
  CountingMemory memory;
  OneThread executor;
  {
    Life life;
    life.some_budget = Budget::Time(std::chrono::milliseconds(5));
    Settings settings = kSettings;
    settings.threads = 2;
    settings.executor = &executor;
    const long before = test::NewCalls();
    Solver solver(settings, &memory);
    EXPECT_EQ(test::NewCalls(), before);
    EXPECT_EQ(solver.bytes(), memory.bytes());
    for (int frame = 0; frame < 300; ++frame) {
      life.Frame(&solver);
      EXPECT_EQ(life.elsewhere(), 0) << "frame " << frame;
      ASSERT_EQ(solver.bytes(), memory.bytes()) << "frame " << frame;
      ASSERT_EQ(solver.most_bytes(), memory.most_bytes()) << "frame " << frame;
    }
    EXPECT_GT(life.steps(), 30);
    EXPECT_GT(executor.tasks(), 0);
    EXPECT_GT(memory.calls(), 500);
    solver.Reset();
    EXPECT_EQ(solver.bytes(), memory.bytes());
    EXPECT_LT(solver.bytes(), solver.most_bytes() / 2);
  }
  executor.Wait();
  EXPECT_EQ(memory.bytes(), 0u);
  EXPECT_EQ(memory.blocks(), 0);
}

TEST(OwnMemory, IsCountedWithoutOneAsWell) {
  CountingMemory memory;
  Life first, second;
  Solver with(kSettings, &memory), without(kSettings);
  for (int frame = 0; frame < 40; ++frame) {
    if (frame % 9 == 7) continue;
    first.Frame(&with);
    second.Frame(&without);
    EXPECT_EQ(with.bytes(), without.bytes()) << frame;
  }
  EXPECT_EQ(with.most_bytes(), without.most_bytes());
  EXPECT_GT(without.bytes(), 100'000u);
  EXPECT_GT(second.elsewhere(), 0);
}

// Each block says whose it is, or the program ends.
// One thread needs no place where others would look for work: that was 9 KB for each of three
// crews.
TEST(OwnMemory, IsLittleWhereLittleIsSolved) {
  Settings several = kSettings;
  several.threads = 2;
  Solver solver(kSettings), with_helpers(several);
  EXPECT_LT(solver.bytes(), 8192u);
  const ManifoldScene scene = test::ManifoldTower(1);
  for (Solver* each : {&solver, &with_helpers}) {
    ManifoldScene frame = scene;
    std::vector<Velocity> velocities(frame.bodies.size());
    Report report;
    each->Solve(frame.problem(), frame.impulses(), velocities, &report);
    ASSERT_TRUE(report.ok()) << Describe(report);
  }
  EXPECT_LT(solver.bytes(), 49152u);  // a box on four points, and a step
  EXPECT_GT(with_helpers.bytes(), solver.bytes() + 8192);
}

TEST(OwnMemory, OfTwoSolversIsKeptApartOnAnyThread) {
  Life expected_life;
  Solver expected(kSettings);
  for (int frame = 0; frame < 60; ++frame) expected_life.Frame(&expected);
  CountingMemory memories[2];
  {
    Life lives[2];
    Solver first(kSettings, &memories[0]), second(kSettings, &memories[1]);
    for (int frame = 0; frame < 20; ++frame) {
      lives[0].Frame(&first);
      lives[1].Frame(&second);
    }
    EXPECT_EQ(first.bytes(), memories[0].bytes());
    EXPECT_EQ(second.bytes(), memories[1].bytes());
    Solver moved(std::move(first));
    std::thread([&] {
      const Solver here_no_longer = [&] {
        Solver here(std::move(moved));
        for (int frame = 0; frame < 40; ++frame) lives[0].Frame(&here);
        EXPECT_EQ(here.bytes(), memories[0].bytes());
        return here;
      }();
    }).join();
    EXPECT_EQ(memories[0].bytes(), 0u);
    for (int frame = 0; frame < 40; ++frame) lives[1].Frame(&second);
    EXPECT_EQ(second.bytes(), memories[1].bytes());
    // over one of another memory
    second = Solver(kSettings, &memories[0]);
    EXPECT_EQ(memories[1].bytes(), 0u);
    EXPECT_EQ(second.bytes(), memories[0].bytes());
    for (const Life& life : lives) {
      EXPECT_EQ(life.elsewhere(), 0);
      EXPECT_EQ(life.sum(), expected_life.sum());
    }
  }
  for (const CountingMemory& memory : memories) EXPECT_EQ(memory.blocks(), 0);
}

TEST(OwnMemory, IsLeftAtTheThreadThatSolved) {
  CountingMemory memory;
  Solver solver(kSettings, &memory);
  Life life;
  life.Frame(&solver);
  const long calls = memory.calls();
  Contacts contacts;
  contacts.Begin({});
  contacts.Add({.id = 1}, std::array{TouchPoint{}});
  const Report copy = [&] {
    ManifoldScene scene = test::ManifoldTower(3);
    std::vector<Velocity> velocities(scene.bodies.size());
    return solver.Solve(scene.problem(), scene.impulses(), velocities);
  }();
  const long after = memory.calls();
  Report kept = copy;
  kept.islands.resize(1000);
  EXPECT_EQ(memory.calls(), after) << "reports are the caller's";
  EXPECT_GT(after, calls);
}

/// Keeps tasks until it is told to run them.
class KeepingExecutor final : public Executor {
 public:
  void Submit(void (*work)(void*), void* what) override { tasks_.emplace_back(work, what); }
  void RunAll() {
    for (const auto& [work, what] : tasks_) std::thread(work, what).join();
  }

 private:
  std::vector<std::pair<void (*)(void*), void*>> tasks_;
};

TEST(OwnMemory, ComesBackWithTheLastTask) {
  CountingMemory memory;
  KeepingExecutor executor;
  {
    Solver solver({.max_sweeps = 2, .threads = 3, .executor = &executor}, &memory);
    ManifoldScene scene = test::ManifoldTower(600);
    std::vector<Velocity> velocities(scene.bodies.size());
    EXPECT_TRUE(solver.Solve(scene.problem(), scene.impulses(), velocities).ok());
  }
  EXPECT_GT(memory.bytes(), 0u);
  EXPECT_LT(memory.bytes(), 10'000u);
  executor.RunAll();
  EXPECT_EQ(memory.bytes(), 0u);
}

TEST(OwnMemory, ThatEndsWhileASolverIsMadeLosesNothing) {
  for (const bool throws : {false, true}) {
    CountingMemory memory;
    if (throws) memory.FailByThrowing();
    int failures = 0;
    for (long call = 0;; ++call, ++failures) {
      memory.FailAfter(call);
      try {
        const Solver solver(kSettings, &memory);
        break;
      } catch (const std::bad_alloc&) {
        EXPECT_EQ(memory.blocks(), 0) << call;
      }
    }
    EXPECT_GT(failures, 2);
    EXPECT_EQ(memory.blocks(), 0);
  }
}

TEST(OwnMemory, HoldsContactsAndJoints) {
  CountingMemory memory;
  {
    const long before = test::NewCalls();
    Contacts contacts({}, &memory);
    Joints joints(0.2, &memory);
    for (int frame = 0; frame < 20; ++frame) {
      const Body bodies[2] = {};
      contacts.Begin({.bodies = bodies});
      joints.Begin({.bodies = bodies});
      for (int i = 0; i < 20 + frame; ++i) {
        const auto id = static_cast<std::uint64_t>(i + 1);
        contacts.Add({.body_a = i % 2, .id = id}, std::array{TouchPoint{.depth = 0.1}});
        joints.Add(HingeJoint(), {.body = i % 2}, {}, id);
      }
    }
    Contacts moved = std::move(contacts);
    EXPECT_EQ(moved.points().size(), 39u);
    EXPECT_EQ(test::NewCalls(), before);
    EXPECT_GT(memory.bytes(), 39 * (sizeof(ContactPoint) + 5 * sizeof(JointRow)));
  }
  EXPECT_EQ(memory.blocks(), 0);
}

TEST(OwnMemory, ThatEndsInHelpersChangesNothing) {
  const Body bodies[2] = {{.inv_mass = 1}, {.inv_mass = 1}}, asleep[2] = {};
  CountingMemory memory;
  Contacts contacts({}, &memory);
  Joints joints(0.2, &memory);
  const auto fill = [&](int frame) {
    const auto whole = [&](const auto& call) {
      for (long allowed = 0;; ++allowed) {
        memory.FailAfter(allowed);
        try {
          call();
          memory.FailAfter(-1);
          return allowed;
        } catch (const std::bad_alloc&) {
        }
      }
    };
    long failures = 0;
    for (const auto& some : {std::span(asleep), std::span(asleep), std::span(bodies)}) {
      failures += whole([&] { contacts.Begin({.bodies = some}); });
      failures += whole([&] { joints.Begin({.bodies = some}); });
    }
    for (int i = 0; i < 20 + 3 * frame; ++i) {
      const auto id = static_cast<std::uint64_t>(i + 1);
      const std::array<TouchPoint, 5> points = {TouchPoint{.depth = 0.1, .feature = 0},
                                                {.depth = 0.2, .feature = 1},
                                                {.depth = 0.3, .feature = 2},
                                                {.depth = 0.4, .feature = 3},
                                                {.depth = 0.5, .feature = 4}};
      failures += whole([&] { contacts.Add({.body_a = i % 2, .id = id}, points); });
      failures += whole([&] { joints.Add(HingeJoint(), {.body = i % 2}, {}, id); });
    }
    return failures;
  };
  long failures = 0;
  for (int frame = 0; frame < 4; ++frame) {
    failures += fill(frame);
    ASSERT_EQ(contacts.points().size(), static_cast<size_t>(5 * (20 + 3 * frame)));
    ASSERT_EQ(contacts.impulses().size(), contacts.points().size());
    ASSERT_EQ(contacts.manifolds().size(), static_cast<size_t>(2 * (20 + 3 * frame)));
    ASSERT_EQ(joints.joints().size(), static_cast<size_t>(20 + 3 * frame));
    ASSERT_EQ(joints.impulses().size(), joints.rows().size());
    // what is kept is found again
    for (size_t i = 0; i < contacts.impulses().size(); ++i) {
      if (frame > 0 && i < 100) {
        ASSERT_EQ(contacts.impulses()[i].normal, static_cast<float>(i));
      }
      contacts.impulses()[i].normal = static_cast<float>(i);
    }
    for (size_t i = 0; i < joints.impulses().size(); ++i) {
      if (frame > 0 && i < 100) {
        ASSERT_EQ(joints.impulses()[i], static_cast<float>(i));
      }
      joints.impulses()[i] = static_cast<float>(i);
    }
  }
  EXPECT_GT(failures, 10);
}

CairnMemory ToC(CountingMemory* memory) {
  return {.allocate =
              [](size_t bytes, size_t alignment, void* context) {
                return static_cast<CountingMemory*>(context)->Allocate(bytes, alignment);
              },
          .free =
              [](void* block, size_t bytes, size_t alignment, void* context) {
                static_cast<CountingMemory*>(context)->Free(block, bytes, alignment);
              },
          .context = memory};
}

TEST(OwnMemory, HoldsAllOfASolverOfC) {
  CountingMemory memory, later;
  ManifoldScene scene = test::ManifoldTower(20), large = test::ManifoldTower(60);
  test::CScene c = test::ToC(&scene), c_large = test::ToC(&large);
  CairnSettings settings = cairnDefaultSettings();
  settings.memory = ToC(&memory);
  settings.relax = true;
  settings.steps = false;
  const long before = test::NewCalls();
  CairnSolver* solver = nullptr;
  ASSERT_EQ(cairnCreateSolver(cairnLayout(), &settings, &solver), cairnOk);
  CairnReport report;
  settings.memory = ToC(&later);
  for (const test::CScene* frame : {&c, &c_large, &c}) {
    ASSERT_EQ(cairnSolve(solver, &frame->problem, &frame->solution, &report), cairnOk);
    size_t most = 0;
    EXPECT_EQ(cairnBytes(solver, &most), memory.bytes());
    EXPECT_EQ(most, memory.most_bytes());
    ASSERT_EQ(cairnSetSettings(solver, &settings), cairnOk);
  }
  EXPECT_EQ(test::NewCalls(), before);
  EXPECT_EQ(later.calls(), 0) << "only at creation";
  cairnDestroySolver(solver);
  EXPECT_EQ(memory.blocks(), 0);
}

/// A link of 1 kg under a ton, which is strained from the second step on.
struct Strained {
  std::array<Body, 2> bodies;
  std::array<Joint, 2> joints = {Joint{.body_a = 0, .rows = 3},
                                 Joint{.body_a = 0, .body_b = 1, .first_row = 3, .rows = 3}};
  std::array<JointRow, 6> rows;
  std::array<float, 6> impulses = {};
  std::array<Velocity, 2> velocities;
  Report report;

  Strained() {
    for (int k = 0; k < 3; ++k) {
      rows[k].linear_a[k] = rows[3 + k].linear_a[k] = 1;
      rows[3 + k].linear_b[k] = -1;
    }
    // arms of half a metre along y
    rows[0].angular_a[2] = rows[5].angular_a[0] = -0.5f;
    rows[2].angular_a[0] = rows[3].angular_a[2] = 0.5f;
    for (int i = 0; i < 2; ++i) {
      bodies[i].inv_mass = i == 0 ? 1 : 1e-3;
      bodies[i].inv_inertia = Matrix3::Diagonal(10, 10, 10);
      bodies[i].impulse = {0, -9.81 / 60 / bodies[i].inv_mass, 0};
      bodies[i].id = static_cast<std::uint64_t>(i + 1);
    }
  }
  void Solve(Solver* solver) {
    const ContactProblem problem{
        .bodies = bodies, .joints = joints, .joint_rows = rows, .time_step = 1 / 60.0};
    solver->Solve(problem, {.joint_rows = impulses}, velocities, &report);
  }
  double strain() const { return report.islands.empty() ? 0 : report.islands[0].strain; }
};

TEST(OwnMemory, HoldsWhatIsKnownOfTension) {
  CountingMemory memory;
  {
    Strained world;
    Solver solver({}, &memory);
    world.Solve(&solver);
    world.Solve(&solver);
    EXPECT_GT(world.strain(), 2);
    const long before = test::NewCalls(), calls = memory.calls();
    for (int i = 0; i < 100; ++i) world.Solve(&solver);
    EXPECT_EQ(memory.calls(), calls);
    EXPECT_EQ(test::NewCalls(), before);
  }
  EXPECT_EQ(memory.blocks(), 0);
}

// What is written is no failure: where there is no memory for tension, it is forgotten.
TEST(OwnMemory, ThatEndsAfterTheResultsIsNoFailure) {
  int failed = 0, forgot = 0;
  bool is_last = false;
  for (long call = 0; !is_last; ++call) {
    CountingMemory memory;
    Strained world;
    Solver solver({}, &memory);
    const long calls = memory.calls();
    world.velocities[0].linear = {7, 7, 7};
    memory.FailAfter(call);
    bool threw = false;
    try {
      world.Solve(&solver);
    } catch (const std::bad_alloc&) {
      threw = true;
    }
    EXPECT_EQ(threw, world.velocities[0].linear == Vector3({7, 7, 7})) << call;
    memory.FailAfter(-1);
    is_last = memory.calls() - calls <= call;
    world.Solve(&solver);
    failed += threw ? 1 : 0;
    forgot += !threw && world.strain() == 0 ? 1 : 0;
  }
  EXPECT_GT(failed, 20);
  EXPECT_GT(forgot, 5);
}

TEST(OwnMemory, ThatEndsIsAStatusInC) {
  CountingMemory memory;
  ManifoldScene scene = test::ManifoldTower(20);
  test::CScene c = test::ToC(&scene);
  CairnSettings settings = cairnDefaultSettings();
  settings.memory = ToC(&memory);
  int failed = 0;
  for (long call = 0; call < 60; ++call) {
    CairnSolver* solver = nullptr;
    memory.FailAfter(call);
    const CairnStatus made = cairnCreateSolver(cairnLayout(), &settings, &solver);
    const CairnStatus solved =
        made == cairnOk ? cairnSolve(solver, &c.problem, &c.solution, nullptr) : made;
    memory.FailAfter(-1);
    EXPECT_TRUE(solved == cairnOk || solved == cairnOutOfMemory) << cairnDescribe(solved);
    failed += solved == cairnOutOfMemory ? 1 : 0;
    EXPECT_EQ(made == cairnOk, solver != nullptr);
    if (solver != nullptr) {
      EXPECT_EQ(cairnSolve(solver, &c.problem, &c.solution, nullptr), cairnOk);
    }
    cairnDestroySolver(solver);
    EXPECT_EQ(memory.blocks(), 0) << call;
  }
  EXPECT_GT(failed, 40);
}

}  // namespace
}  // namespace cairn
