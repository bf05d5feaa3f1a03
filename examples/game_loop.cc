// SPDX-License-Identifier: MIT
// A game loop: fixed steps of 1/60 s, pictures whenever the screen wants one, 2 ms a picture for
// the solver, and a line a second about how good its answers were.
#include <cairn/bullet/constraint_solver.h>

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <vector>

namespace {

constexpr btScalar kStep = btScalar(1) / 60;  // [s]
constexpr int kMostStepsOfPicture = 4;        // after a hitch the game slows down instead
constexpr std::chrono::microseconds kSolverTime{2000};

/// A tower of boxes on a plane, each with its transform of the step before.
class World {
 public:
  explicit World(btConstraintSolver* solver)
      : dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, solver, &configuration_),
        ground_shape_(btVector3(0, 1, 0), 0),
        box_shape_(btVector3(1, 1, 1) / 2) {
    world_.setGravity(btVector3(0, btScalar(-9.81), 0));
    Add(0, &ground_shape_, 0);
    for (int i = 0; i < 20; ++i) Add(1, &box_shape_, btScalar(i) + btScalar(0.5));
  }
  ~World() {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  void Step() {
    for (size_t i = 0; i < bodies_.size(); ++i) before_[i] = bodies_[i]->getWorldTransform();
    world_.stepSimulation(kStep, 0);
  }

  /// Where to draw the top, a share of a step after the last but one.
  btScalar HeightOfTop(btScalar share) const {
    const btVector3 now = bodies_.back()->getWorldTransform().getOrigin();
    return before_.back().getOrigin().lerp(now, share).y() + btScalar(0.5);
  }

 private:
  void Add(btScalar mass, btCollisionShape* shape, btScalar height) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    bodies_.push_back(std::make_unique<btRigidBody>(mass, nullptr, shape, inertia));
    const btTransform start(btQuaternion::getIdentity(), btVector3(0, height, 0));
    bodies_.back()->setWorldTransform(start);
    before_.push_back(start);
    world_.addRigidBody(bodies_.back().get());
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btDiscreteDynamicsWorld world_;
  btStaticPlaneShape ground_shape_;
  btBoxShape box_shape_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<btTransform> before_;
};

/// What a second of steps was worth.
struct Quality {
  int steps = 0, factorisations = 0, late = 0;
  double residual = 0;

  void Add(const cairn::Report& report) {
    ++steps;
    factorisations += report.factorisations;
    late += report.stop == cairn::StopReason::kTimeSpent ? 1 : 0;
    residual = std::max(residual, report.residual_max);
  }
};

}  // namespace

int main() {
  cairn::bullet::ConstraintSolver solver;
  World world(&solver);

  // a screen of 144 Hz, and a hitch of a tenth of a second now and then
  btScalar unspent = 0;
  for (int second = 1; second <= 3; ++second) {
    Quality quality;
    int pictures = 0;
    for (btScalar time = 0; time < 1; ++pictures) {
      const btScalar passed = pictures == 50 ? btScalar(0.1) : btScalar(1) / 144;
      time += passed;
      unspent = std::min(unspent + passed, kMostStepsOfPicture * kStep);

      // the steps of a picture share its time
      const int steps = static_cast<int>(unspent / kStep);
      if (steps > 0) solver.settings().budget = cairn::Budget::Time(kSolverTime / steps);
      for (int i = 0; i < steps; ++i, unspent -= kStep) {
        world.Step();
        quality.Add(solver.report());
      }
      world.HeightOfTop(unspent / kStep);  // and draw it there
    }
    std::printf(
        "second %d: %d pictures, %d steps; worst error %.1e m/s, %d Cholesky factorisations, "
        "%d steps ended by the clock; top at %.2f m\n",
        second, pictures, quality.steps, quality.residual, quality.factorisations, quality.late,
        static_cast<double>(world.HeightOfTop(unspent / kStep)));
  }
}
