// SPDX-License-Identifier: MIT
#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolverMt.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <btBulletDynamicsCommon.h>
#include <cairn/bullet/constraint_solver_pool.h>
#include <cairn/bullet/task_scheduler.h>
#include <fmt/format.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "frames/experiments.h"
#include "support/machine/run_context.h"
#include "support/machine/stopwatch.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::frames {
namespace {

constexpr int kIterations = 10;

/// Boxes of 1 m in some world: a wall that narrows to one box, or so many that fall into a pit.
class Boxes {
 public:
  enum class Kind { kPyramid, kRain };

  Boxes(Kind kind, btDiscreteDynamicsWorld* world) : world_(*world) {
    world_.setGravity(btVector3(0, btScalar(-9.81), 0));
    world_.getSolverInfo().m_numIterations = kIterations;
    world_.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    Add(0, &ground_, btVector3(0, -1, 0));
    if (kind == Kind::kPyramid) {
      AddPyramid();
    } else {
      AddRain();
    }
  }
  ~Boxes() {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  Boxes(const Boxes&) = delete;
  Boxes& operator=(const Boxes&) = delete;

 private:
  static constexpr int kLayers = 100, kSide = 15, kRainLayers = 14;

  void AddPyramid() {
    for (int layer = 0; layer < kLayers; ++layer) {
      for (int i = 0; i < kLayers - layer; ++i) {
        const btScalar x = btScalar(1.02) * (btScalar(i) + btScalar(0.5) * btScalar(layer));
        Add(1, &box_, btVector3(x, btScalar(0.5) + btScalar(layer), 0));
      }
    }
  }

  void AddRain() {
    for (const btScalar side : {btScalar(-1), btScalar(1)}) {
      Add(0, &wall_x_, btVector3(side * (kSide + 1), 20, 0));
      Add(0, &wall_z_, btVector3(0, 20, side * (kSide + 1)));
    }
    for (int layer = 0; layer < kRainLayers; ++layer) {
      for (int i = 0; i < kSide * kSide; ++i) {
        const btScalar shift = btScalar(0.11) * btScalar(layer % 5);
        Add(1, &box_,
            btVector3(btScalar(1.7) * btScalar(i % kSide - kSide / 2) + shift,
                      1 + btScalar(1.6) * btScalar(layer),
                      btScalar(1.7) * btScalar(i / kSide - kSide / 2) - shift));
      }
    }
  }

  void Add(btScalar mass, btCollisionShape* shape, const btVector3& at) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    bodies_.push_back(std::make_unique<btRigidBody>(mass, nullptr, shape, inertia));
    btRigidBody* const body = bodies_.back().get();
    body->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
    if (mass > 0) body->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(body);
  }

  btDiscreteDynamicsWorld& world_;
  btBoxShape ground_{btVector3(200, 1, 200)};
  btBoxShape box_{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
  btBoxShape wall_x_{btVector3(1, 20, kSide + 2)}, wall_z_{btVector3(kSide + 2, 20, 1)};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

/// A world on so many threads, its own scheduler and solvers with it, and what its steps took [ms].
class Contestant {
 public:
  virtual ~Contestant() = default;
  void Step(bool keep) {
    btSetTaskScheduler(&scheduler());
    const cli::Stopwatch stopwatch(cli::SolverClock::kWall);
    world().stepSimulation(btScalar(1) / 60, 0, btScalar(1) / 60);
    if (!keep) return;
    steps.push_back(stopwatch.Read());
    solvers.push_back(solver_time());
  }
  std::vector<double> steps, solvers;

 protected:
  virtual btITaskScheduler& scheduler() = 0;
  virtual btDiscreteDynamicsWorldMt& world() = 0;
  virtual double solver_time() const = 0;
};

/// Measures what solving takes, islands apart: from the first group to the last.
template <class World>
class TimedIslands final : public World {
 public:
  using World::World;
  double solver_time() const { return solver_time_; }

 private:
  void solveConstraints(btContactSolverInfo& info) override {
    const cli::Stopwatch stopwatch(cli::SolverClock::kWall);
    World::solveConstraints(info);
    solver_time_ = stopwatch.Read();
  }
  double solver_time_ = 0;
};

class OfCairn final : public Contestant {
 public:
  OfCairn(Boxes::Kind kind, int threads)
      : scheduler_(threads), pool_(Sweeps(kIterations, threads)) {
    btSetTaskScheduler(&scheduler_);
    dispatcher_ = std::make_unique<btCollisionDispatcherMt>(&configuration_);
    world_ = std::make_unique<TimedIslands<btDiscreteDynamicsWorldMt>>(
        dispatcher_.get(), &broadphase_, &pool_, nullptr, &configuration_);
    boxes_ = std::make_unique<Boxes>(kind, world_.get());
  }

 private:
  btITaskScheduler& scheduler() override { return scheduler_; }
  btDiscreteDynamicsWorldMt& world() override { return *world_; }
  double solver_time() const override { return world_->solver_time(); }

  bullet::TaskScheduler scheduler_;
  bullet::ConstraintSolverPool pool_;
  btDefaultCollisionConfiguration configuration_;
  std::unique_ptr<btCollisionDispatcherMt> dispatcher_;
  btDbvtBroadphase broadphase_;
  std::unique_ptr<TimedIslands<btDiscreteDynamicsWorldMt>> world_;
  std::unique_ptr<Boxes> boxes_;
};

class OfBullet final : public Contestant {
 public:
  OfBullet(Boxes::Kind kind, int threads) : pool_(threads) {
    scheduler_.reset(btCreateDefaultTaskScheduler());
    scheduler_->setNumThreads(threads);
    btSetTaskScheduler(scheduler_.get());
    dispatcher_ = std::make_unique<btCollisionDispatcherMt>(&configuration_);
    world_ = std::make_unique<TimedIslands<btDiscreteDynamicsWorldMt>>(
        dispatcher_.get(), &broadphase_, &pool_, &large_, &configuration_);
    boxes_ = std::make_unique<Boxes>(kind, world_.get());
  }
  ~OfBullet() override {
    boxes_.reset();
    btSetTaskScheduler(btGetSequentialTaskScheduler());
  }

 private:
  btITaskScheduler& scheduler() override { return *scheduler_; }
  btDiscreteDynamicsWorldMt& world() override { return *world_; }
  double solver_time() const override { return world_->solver_time(); }

  std::unique_ptr<btITaskScheduler> scheduler_;
  btConstraintSolverPoolMt pool_;
  btSequentialImpulseConstraintSolverMt large_;
  btDefaultCollisionConfiguration configuration_;
  std::unique_ptr<btCollisionDispatcherMt> dispatcher_;
  btDbvtBroadphase broadphase_;
  std::unique_ptr<TimedIslands<btDiscreteDynamicsWorldMt>> world_;
  std::unique_ptr<Boxes> boxes_;
};

}  // namespace

void PrintMtWorlds(const ThreadOptions& options, const std::string& command) {
  const std::string complaint = bullet::TaskScheduler(1).complaint();
  if (!complaint.empty()) throw std::runtime_error(complaint);
  fmt::print("{}", cli::Origin("Bullet's multithreaded world, with its own solvers and with Cairn",
                               cli::DescribeContext(command)));
  fmt::print(
      "- btDiscreteDynamicsWorldMt, ten iterations, no subspace step; Bullet: its scheduler, its "
      "pool and\n  btSequentialImpulseConstraintSolverMt; Cairn: TaskScheduler and "
      "ConstraintSolverPool\n"
      "- {} frames, the worlds in turn; medians, wall clock, ms. Solver: islands and all that is "
      "done to them\n\n",
      options.window.frames);
  cli::TextTable table =
      cli::TableOf({"scene", "threads", "step, Bullet", "of it solver", "step, Cairn",
                    "of it solver", "Bullet / Cairn, solver", "Cairn's step on one / this"});
  for (const auto& [kind, name] : {std::pair{Boxes::Kind::kPyramid, "pyramid of 5050"},
                                   {Boxes::Kind::kRain, "3150 falling"}}) {
    double one = 0;
    for (const int threads : options.threads) {
      OfBullet bullet(kind, threads);
      OfCairn cairn(kind, threads);
      for (int frame = 0; frame < options.window.frame + options.window.frames; ++frame) {
        bullet.Step(frame >= options.window.frame);
        cairn.Step(frame >= options.window.frame);
      }
      const auto ms = [](const std::vector<double>& times) {
        return fmt::format("{:.2f}", cli::Median(times));
      };
      if (one == 0) one = cli::Median(cairn.steps);
      table.rows.push_back(
          {name, fmt::format("{}", threads), ms(bullet.steps), ms(bullet.solvers), ms(cairn.steps),
           ms(cairn.solvers),
           fmt::format("{:.1f}", cli::Median(bullet.solvers) / cli::Median(cairn.solvers)),
           fmt::format("{:.2f}", one / cli::Median(cairn.steps))});
    }
  }
  fmt::print("{}\n", table.ToMarkdown());
}

}  // namespace cairn::frames
