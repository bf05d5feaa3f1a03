// SPDX-License-Identifier: MIT
// Bullet's multithreaded world: loops on the threads of the solver, and groups from many threads.
#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <LinearMath/btThreads.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <random>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "cairn/bullet/constraint_solver_pool.h"
#include "cairn/bullet/task_scheduler.h"
#include "tests/bullet_adapter/mt/pile.h"
#include "tests/bullet_adapter/scene_world.h"

namespace cairn::test {
namespace {

using bullet::ConstraintSolverPool;
using bullet::TaskScheduler;

/// Whether this Bullet may be used by several threads.
bool BulletLocks() {
  btSpinMutex lock;
  lock.tryLock();
  return !lock.tryLock();
}

/// A world whose swept bodies are moved by one thread: btDiscreteDynamicsWorldMt moves bodies while
/// others are swept against them, and then what they hit depends on who was first.
class OrderlyWorld final : public btDiscreteDynamicsWorldMt {
 public:
  using btDiscreteDynamicsWorldMt::btDiscreteDynamicsWorldMt;

 private:
  void integrateTransforms(btScalar time_step) override {
    btDiscreteDynamicsWorld::integrateTransforms(time_step);
  }
};

/// The job system of a game: so many threads that take what is there.
class Jobs final : public Executor {
 public:
  explicit Jobs(int threads) {
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { Work(); });
  }
  ~Jobs() override {
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    there_is_one_.notify_all();
    for (std::thread& thread : threads_) thread.join();
    for (const auto& [work, what] : jobs_) work(what);
  }
  void Submit(void (*work)(void*), void* what) override {
    {
      const std::lock_guard lock(mutex_);
      jobs_.emplace_back(work, what);
    }
    there_is_one_.notify_one();
  }

 private:
  void Work() {
    for (;;) {
      std::unique_lock lock(mutex_);
      there_is_one_.wait(lock, [this] { return over_ || !jobs_.empty(); });
      if (over_) return;
      const auto [work, what] = jobs_.front();
      jobs_.pop_front();
      lock.unlock();
      work(what);
    }
  }

  std::mutex mutex_;
  std::condition_variable there_is_one_;
  std::deque<std::pair<void (*)(void*), void*>> jobs_;
  bool over_ = false;
  std::vector<std::thread> threads_;
};

/// Threads of a process get their number in Bullet once, and there are 64: these serve all tests.
Executor* SharedJobs() {
  static Jobs jobs(15);
  return &jobs;
}

/// Sets a scheduler for as long as it lives.
class Scheduled {
 public:
  explicit Scheduled(int threads, Executor* executor = nullptr) : scheduler_(threads, executor) {
    btSetTaskScheduler(&scheduler_);
  }
  TaskScheduler& scheduler() { return scheduler_; }

 private:
  TaskScheduler scheduler_;
};

TEST(TaskScheduler, StartsThreadsOnlyWhereBulletLocks) {
  TaskScheduler scheduler(3);
  if (BulletLocks()) {
    EXPECT_EQ(scheduler.threads(), 3);
    EXPECT_EQ(scheduler.complaint(), "");
  } else {
    EXPECT_EQ(scheduler.threads(), 1);
    EXPECT_THAT(scheduler.complaint(), testing::HasSubstr("bash cmake/build-bullet-mt.sh"));
    scheduler.setNumThreads(8);
    EXPECT_EQ(scheduler.threads(), 1);
  }
}

TEST(TaskScheduler, LeavesNothingOfItselfInBullet) {
  { const Scheduled scheduled(2); }
  EXPECT_EQ(btGetTaskScheduler(), btGetSequentialTaskScheduler());
}

class Marks final : public btIParallelForBody {
 public:
  explicit Marks(int size, const Marks* inner = nullptr) : marks_(size), inner_(inner) {}
  void forLoop(int begin, int end) const override {
    for (int i = begin; i < end; ++i) marks_[i].fetch_add(1);
    if (inner_ == nullptr) return;
    btGetTaskScheduler()->parallelFor(0, static_cast<int>(inner_->marks_.size()), 2, *inner_);
    loops_.fetch_add(1);
  }
  void ExpectEach(int times, int from = 0) const {
    for (size_t i = from; i < marks_.size(); ++i) ASSERT_EQ(marks_[i], times) << i;
  }
  int loops() const { return loops_; }

 private:
  mutable std::vector<std::atomic<int>> marks_;
  mutable std::atomic<int> loops_{0};
  const Marks* inner_;
};

TEST(TaskScheduler, DoesEachIndexOnce) {
  for (Executor* const executor : {static_cast<Executor*>(nullptr), SharedJobs()}) {
    for (const int threads : {1, 2, 3, 8, 16}) {
      Scheduled scheduled(threads, executor);
      for (const int grain : {0, 1, 7, 40, 1000}) {
        const Marks marks(500);
        scheduled.scheduler().parallelFor(3, 500, grain, marks);
        marks.ExpectEach(1, 3);
      }
    }
  }
}

TEST(TaskScheduler, DoesALoopInALoopWhereItIsMet) {
  Scheduled scheduled(4, SharedJobs());
  const Marks inner(20), outer(64, &inner);
  scheduled.scheduler().parallelFor(0, 64, 4, outer);
  outer.ExpectEach(1);
  inner.ExpectEach(outer.loops());
  EXPECT_GE(outer.loops(), 1);
}

/// Throws at one index.
class Throws final : public btIParallelForBody {
 public:
  void forLoop(int begin, int end) const override {
    if (begin <= 150 && 150 < end) throw std::runtime_error("150");
  }
};

TEST(TaskScheduler, GoesOnAfterALoopThatThrew) {
  for (Executor* const executor : {static_cast<Executor*>(nullptr), SharedJobs()}) {
    Scheduled scheduled(3, executor);
    for (int i = 0; i < 3; ++i) {
      EXPECT_THROW(scheduled.scheduler().parallelFor(0, 300, 10, Throws()), std::runtime_error);
      EXPECT_FALSE(btThreadsAreRunning());
      const Marks marks(300);
      scheduled.scheduler().parallelFor(0, 300, 10, marks);
      marks.ExpectEach(1);
    }
  }
}

/// 1, 1/2, 1/3 ...: sums of floats that differ where their order does.
class Harmonic final : public btIParallelSumBody {
 public:
  btScalar sumLoop(int begin, int end) const override {
    btScalar sum = 0;
    for (int i = begin; i < end; ++i) sum += btScalar(1) / btScalar(i + 1);
    return sum;
  }
};

TEST(TaskScheduler, AddsUpTheSameForAnyNumberOfThreads) {
  const auto sum = [](int threads) {
    Scheduled scheduled(threads, SharedJobs());
    return scheduled.scheduler().parallelSum(0, 10000, 50, Harmonic());
  };
  const btScalar expected = sum(1);
  // the harmonic number, by Euler and Maclaurin: ln n + 0.5772 + 1 / (2 n)
  EXPECT_NEAR(expected, 9.787606, 1e-4);
  for (const int threads : {2, 3, 5, 16}) EXPECT_EQ(sum(threads), expected);
}

/// A job system that never has time.
class NoThreads final : public Executor {
 public:
  ~NoThreads() override {
    for (const auto& [work, what] : tasks_) work(what);
  }
  void Submit(void (*work)(void*), void* what) override { tasks_.emplace_back(work, what); }

 private:
  std::vector<std::pair<void (*)(void*), void*>> tasks_;
};

TEST(TaskScheduler, FinishesAloneWhereNobodyComes) {
  NoThreads nobody;
  Scheduled scheduled(8, &nobody);
  for (int i = 0; i < 5; ++i) {
    const Marks marks(300);
    scheduled.scheduler().parallelFor(0, 300, 10, marks);
    marks.ExpectEach(1);
  }
}

/// Hands groups to a pool shuffled, and each from another thread.
class Shuffling final : public btSequentialImpulseConstraintSolver {
 public:
  Shuffling(ConstraintSolverPool* pool, unsigned seed) : pool_(*pool), random_(seed) {}

  void prepareSolve(int bodies, int manifolds) override {
    groups_.clear();
    pool_.prepareSolve(bodies, manifolds);
  }
  btScalar solveGroup(btCollisionObject** bodies, int num_bodies, btPersistentManifold** manifolds,
                      int num_manifolds, btTypedConstraint** constraints, int num_constraints,
                      const btContactSolverInfo&, btIDebugDraw*, btDispatcher*) override {
    Group& group = groups_.emplace_back();
    group.bodies.assign(bodies, bodies + num_bodies);
    group.manifolds.assign(manifolds, manifolds + num_manifolds);
    group.joints.assign(constraints, constraints + num_constraints);
    return 0;
  }
  void allSolved(const btContactSolverInfo& info, btIDebugDraw* drawer) override {
    std::shuffle(groups_.begin(), groups_.end(), random_);
    std::vector<std::thread> threads;
    for (Group& group : groups_) {
      std::shuffle(group.bodies.begin(), group.bodies.end(), random_);
      std::shuffle(group.manifolds.begin(), group.manifolds.end(), random_);
      const auto hand_over = [&] {
        const auto size = [](const auto& list) { return static_cast<int>(list.size()); };
        pool_.solveGroup(group.bodies.data(), size(group.bodies), group.manifolds.data(),
                         size(group.manifolds), group.joints.data(), size(group.joints), info,
                         drawer, nullptr);
      };
      threads.emplace_back(hand_over);
    }
    for (std::thread& thread : threads) thread.join();
    pool_.allSolved(info, drawer);
  }

 private:
  struct Group {
    std::vector<btCollisionObject*> bodies;
    std::vector<btPersistentManifold*> manifolds;
    std::vector<btTypedConstraint*> joints;
  };
  ConstraintSolverPool& pool_;
  std::mt19937 random_;
  std::vector<Group> groups_;
};

TEST(ConstraintSolverPool, DoesNotSeeInWhatOrderGroupsCome) {
  for (const char* const scene : {"rubble", "ragdolls"}) {
    const auto hash = [scene](unsigned seed, int threads) {
      ConstraintSolverPool pool({.threads = threads});
      Shuffling solver(&pool, seed);
      SceneWorld world(scene, &solver);
      world.world().solver_info().m_minimumSolverBatchSize = 1;
      world.Step(40);
      EXPECT_TRUE(pool.report().ok());
      EXPECT_GT(pool.report().islands.size(), 0u);
      return bench::StateHash(world.world());
    };
    const std::uint64_t expected = hash(1, 1);
    EXPECT_EQ(hash(2, 1), expected) << scene;
    EXPECT_EQ(hash(3, 2), expected) << scene;
  }
}

TEST(ConstraintSolverPool, SolvesAGroupOutsideOfASubstepAtOnce) {
  ConstraintSolverPool pool;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &pool, &configuration);
  btSphereShape shape(1);
  btRigidBody body(1, nullptr, &shape, btVector3(1, 1, 1));
  world.addRigidBody(&body);
  btCollisionObject* bodies[] = {&body};
  body.applyCentralForce(btVector3(60, 0, 0));
  world.getSolverInfo().m_timeStep = btScalar(1) / 60;
  pool.solveGroup(bodies, 1, nullptr, 0, nullptr, 0, world.getSolverInfo(), nullptr, &dispatcher);
  // force times time over mass
  EXPECT_NEAR(body.getLinearVelocity().x(), 1, 1e-6);
  world.removeRigidBody(&body);
}

TEST(ConstraintSolver, ReadsAndWritesTheSameOnAnyNumberOfThreads) {
  const auto hash = [](int threads, Executor* executor) {
    bullet::ConstraintSolver solver(Settings{.threads = threads, .executor = executor});
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
    Pile pile(&world, 14);
    int most = 0;
    for (int frame = 0; frame < 130; ++frame) {
      pile.Step(1);
      int rows = 0;
      for (const IslandReport& island : solver.report().islands) rows += island.rows;
      most = std::max(most, rows);
    }
    // enough for three threads; smaller ones stay on one
    EXPECT_GT(most, 3 * 2048);
    return pile.Hash();
  };
  const std::uint64_t expected = hash(1, nullptr);
  EXPECT_EQ(hash(2, nullptr), expected);
  EXPECT_EQ(hash(3, SharedJobs()), expected);
  EXPECT_EQ(hash(16, SharedJobs()), expected);
  NoThreads nobody;
  EXPECT_EQ(hash(4, &nobody), expected);
}

/// Tests of what only a Bullet for several threads can do.
class MtBullet : public testing::Test {
 protected:
  void SetUp() override {
    if (BulletLocks()) return;
    GTEST_SKIP() << "this Bullet was built without BT_THREADSAFE; bash cmake/build-bullet-mt.sh "
                    "builds one, and -DBULLET_ROOT finds it";
  }

  static std::uint64_t HashAfter(int frames, int threads, Executor* executor,
                                 const Settings& like = {}) {
    Scheduled scheduled(threads, executor);
    Settings settings = like;
    settings.threads = threads;
    settings.executor = executor;
    ConstraintSolverPool pool(settings);
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcherMt dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    OrderlyWorld world(&dispatcher, &broadphase, &pool, nullptr, &configuration);
    Pile pile(&world);
    pile.Step(frames);
    EXPECT_TRUE(pool.report().ok()) << pool.solver().complaint();
    return pile.Hash();
  }
};

TEST_F(MtBullet, MakesTheSameWorldOnAnyNumberOfThreads) {
  constexpr int kFrames = 300;
  const std::uint64_t expected = HashAfter(kFrames, 1, nullptr);
  for (const int threads : {2, 3, 5, 8, 16}) {
    EXPECT_EQ(HashAfter(kFrames, threads, nullptr), expected) << threads;
    EXPECT_EQ(HashAfter(kFrames, threads, SharedJobs()), expected) << threads << " of the host";
  }
}

TEST_F(MtBullet, MakesTheSameWorldWithSweepsAlone) {
  const Settings sweeps{.method = Method::kPgs};
  const std::uint64_t expected = HashAfter(100, 1, nullptr, sweeps);
  EXPECT_EQ(HashAfter(100, 8, SharedJobs(), sweeps), expected);
}

TEST_F(MtBullet, MakesTheSameWorldWhereNobodyComes) {
  NoThreads nobody;
  EXPECT_EQ(HashAfter(60, 8, &nobody), HashAfter(60, 1, nullptr));
}

}  // namespace
}  // namespace cairn::test
