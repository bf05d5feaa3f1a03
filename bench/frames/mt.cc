// SPDX-License-Identifier: MIT
#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolverMt.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <btBulletDynamicsCommon.h>
#include <cairn/bullet/constraint_solver_pool.h>
#include <cairn/bullet/task_scheduler.h>
#include <fmt/format.h>

#include <array>
#include <functional>
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

/// What the parts of a step took [ms].
struct StepTimes {
  double step = 0, collisions = 0, islands = 0, solver = 0;
  double rest() const { return step - collisions - islands - solver; }
};

/// Adds what a call takes to a time.
template <class Call>
void Time(double* time, const Call& call) {
  const cli::Stopwatch stopwatch(cli::SolverClock::kWall);
  call();
  *time += stopwatch.Read();
}

/// A world on so many threads, its own scheduler and solvers with it.
class Contestant {
 public:
  virtual ~Contestant() = default;
  void Step(bool keep) {
    btSetTaskScheduler(&scheduler());
    times() = {};
    Time(&times().step, [&] { world().stepSimulation(btScalar(1) / 60, 0, btScalar(1) / 60); });
    if (keep) steps_.push_back(times());
  }
  const std::vector<StepTimes>& steps() const { return steps_; }

 protected:
  virtual btITaskScheduler& scheduler() = 0;
  virtual btDiscreteDynamicsWorldMt& world() = 0;
  virtual StepTimes& times() = 0;

 private:
  std::vector<StepTimes> steps_;
};

/// Measures what its parts take.
class TimedWorld final : public btDiscreteDynamicsWorldMt {
 public:
  using btDiscreteDynamicsWorldMt::btDiscreteDynamicsWorldMt;
  StepTimes times;

  void performDiscreteCollisionDetection() override {
    Time(&times.collisions, [this] { Base::performDiscreteCollisionDetection(); });
  }

 private:
  using Base = btDiscreteDynamicsWorldMt;
  void calculateSimulationIslands() override {
    Time(&times.islands, [this] { Base::calculateSimulationIslands(); });
  }
  /// From the first group to the last.
  void solveConstraints(btContactSolverInfo& info) override {
    Time(&times.solver, [&] { Base::solveConstraints(info); });
  }
};

class OfCairn final : public Contestant {
 public:
  OfCairn(Boxes::Kind kind, Work work, int threads)
      : scheduler_(threads), pool_(SettingsFor(work, threads)) {
    btSetTaskScheduler(&scheduler_);
    dispatcher_ = std::make_unique<btCollisionDispatcherMt>(&configuration_);
    world_ = std::make_unique<TimedWorld>(dispatcher_.get(), &broadphase_, &pool_, nullptr,
                                          &configuration_);
    boxes_ = std::make_unique<Boxes>(kind, world_.get());
  }

 private:
  btITaskScheduler& scheduler() override { return scheduler_; }
  btDiscreteDynamicsWorldMt& world() override { return *world_; }
  StepTimes& times() override { return world_->times; }

  bullet::TaskScheduler scheduler_;
  bullet::ConstraintSolverPool pool_;
  btDefaultCollisionConfiguration configuration_;
  std::unique_ptr<btCollisionDispatcherMt> dispatcher_;
  btDbvtBroadphase broadphase_;
  std::unique_ptr<TimedWorld> world_;
  std::unique_ptr<Boxes> boxes_;
};

class OfBullet final : public Contestant {
 public:
  OfBullet(Boxes::Kind kind, int threads) : pool_(threads) {
    scheduler_.reset(btCreateDefaultTaskScheduler());
    scheduler_->setNumThreads(threads);
    btSetTaskScheduler(scheduler_.get());
    dispatcher_ = std::make_unique<btCollisionDispatcherMt>(&configuration_);
    world_ = std::make_unique<TimedWorld>(dispatcher_.get(), &broadphase_, &pool_, &large_,
                                          &configuration_);
    boxes_ = std::make_unique<Boxes>(kind, world_.get());
  }
  ~OfBullet() override {
    boxes_.reset();
    btSetTaskScheduler(btGetSequentialTaskScheduler());
  }

 private:
  btITaskScheduler& scheduler() override { return *scheduler_; }
  btDiscreteDynamicsWorldMt& world() override { return *world_; }
  StepTimes& times() override { return world_->times; }

  std::unique_ptr<btITaskScheduler> scheduler_;
  btConstraintSolverPoolMt pool_;
  btSequentialImpulseConstraintSolverMt large_;
  btDefaultCollisionConfiguration configuration_;
  std::unique_ptr<btCollisionDispatcherMt> dispatcher_;
  btDbvtBroadphase broadphase_;
  std::unique_ptr<TimedWorld> world_;
  std::unique_ptr<Boxes> boxes_;
};

/// In a world that is gone when it returns: threads of one that wait for work delay another.
template <class World, class... What>
std::vector<StepTimes> StepsOf(const WindowOptions& window, const What&... what) {
  World world(what...);
  for (int frame = 0; frame < window.frame + window.frames; ++frame) {
    world.Step(frame >= window.frame);
  }
  return world.steps();
}

template <class Value>
double MedianOf(const std::vector<StepTimes>& steps, const Value& value) {
  std::vector<double> values;
  for (const StepTimes& times : steps) values.push_back(std::invoke(value, times));
  return cli::Median(values);
}

}  // namespace

void PrintMtWorlds(const ThreadOptions& options, const std::string& command) {
  const std::string complaint = bullet::TaskScheduler(1).complaint();
  if (!complaint.empty()) throw std::runtime_error(complaint);
  fmt::print("{}", cli::Origin("Bullet's multithreaded world, with its own solvers and with Cairn",
                               cli::DescribeContext(command)));
  fmt::print(
      "- btDiscreteDynamicsWorldMt, ten iterations; Bullet: its scheduler, its pool and\n"
      "  btSequentialImpulseConstraintSolverMt; Cairn: TaskScheduler and ConstraintSolverPool, {}\n"
      "- {} frames, one world after the other; medians, wall clock, ms. Solver: from the first "
      "group to "
      "the last\n\n",
      Describe(options.work), options.window.frames);
  cli::TextTable table =
      cli::TableOf({"scene", "threads", "solver of", "step", "collisions", "islands", "solver",
                    "rest", "step on one / this", "Bullet / Cairn, solver"});
  for (const auto& [kind, name] : {std::pair{Boxes::Kind::kPyramid, "pyramid of 5050"},
                                   {Boxes::Kind::kRain, "3150 falling"}}) {
    std::array<double, 2> one{};
    for (const int threads : options.threads) {
      const auto bullet = StepsOf<OfBullet>(options.window, kind, threads);
      const auto cairn = StepsOf<OfCairn>(options.window, kind, options.work, threads);
      const auto add = [&](const char* who, const std::vector<StepTimes>& steps, double* first,
                           std::string ratio) {
        const double step = MedianOf(steps, &StepTimes::step);
        if (*first == 0) *first = step;
        const auto ms = [&](const auto& part) {
          return fmt::format("{:.2f}", MedianOf(steps, part));
        };
        table.rows.push_back({name, fmt::format("{}", threads), who, ms(&StepTimes::step),
                              ms(&StepTimes::collisions), ms(&StepTimes::islands),
                              ms(&StepTimes::solver), ms(&StepTimes::rest),
                              fmt::format("{:.2f}", *first / step), std::move(ratio)});
      };
      const double ratio =
          MedianOf(bullet, &StepTimes::solver) / MedianOf(cairn, &StepTimes::solver);
      add("Bullet", bullet, &one[0], "");
      add("Cairn", cairn, &one[1], fmt::format("{:.1f}", ratio));
    }
  }
  fmt::print("{}\n", table.ToMarkdown());
}

}  // namespace cairn::frames
