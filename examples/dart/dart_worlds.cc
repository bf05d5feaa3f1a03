// SPDX-License-Identifier: MIT
// Worlds of DART with its Dantzig and PGS solvers and with Cairn: stacked boxes, a humanoid that
// stands, closed loops.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <dart/collision/dart/DARTCollisionDetector.hpp>
#include <dart/constraint/BallJointConstraint.hpp>
#include <dart/constraint/BoxedLcpConstraintSolver.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/constraint/DantzigBoxedLcpSolver.hpp>
#include <dart/constraint/PgsBoxedLcpSolver.hpp>
#include <dart/dynamics/BallJoint.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/EulerJoint.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/ShapeNode.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "boxed_lcp_solver.h"

namespace {

using dart::constraint::BoxedLcpSolver;

/// Solves with another solver, and takes its time and what it leaves.
class Measured final : public BoxedLcpSolver {
 public:
  explicit Measured(std::shared_ptr<BoxedLcpSolver> solver) : solver_(std::move(solver)) {}

  const std::string& getType() const override { return solver_->getType(); }
  bool solve(int n, double* A, double* x, double* b, int nub, double* lo, double* hi, int* findex,
             bool early) override {
    // Dantzig writes into all of them
    const int length = n * cairn::dart::RowLength(n);
    const std::vector<double> a(A, A + length), right(b, b + n), low(lo, lo + n), high(hi, hi + n);
    const std::vector<int> parents(findex, findex + n);
    const auto begin = std::chrono::steady_clock::now();
    const bool solved = solver_->solve(n, A, x, b, nub, lo, hi, findex, early);
    const auto end = std::chrono::steady_clock::now();
    microseconds.push_back(std::chrono::duration<double, std::micro>(end - begin).count());
    residuals.push_back(cairn::dart::LargestResidual(n, a.data(), x, right.data(), low.data(),
                                                     high.data(), parents.data()));
    rows = std::max(rows, n);
    failed += solved ? 0 : 1;
    return solved;
  }
#ifdef NDEBUG
  bool canSolve(int, const double*) { return true; }
#else
  bool canSolve(int, const double*) override { return true; }
#endif

  std::vector<double> microseconds, residuals;
  int rows = 0, failed = 0;

 private:
  std::shared_ptr<BoxedLcpSolver> solver_;
};

namespace dyn = dart::dynamics;
using dart::simulation::WorldPtr;
using Eigen::Vector3d;

constexpr double kStep = 1e-3;  // [s]

/// Makes a body of a box whose middle is @p middle in the frame of the body.
void Shape(const Vector3d& sides, double mass, const Vector3d& middle, dyn::BodyNode* body) {
  const auto box = std::make_shared<dyn::BoxShape>(sides);
  body->setInertia(dyn::Inertia(mass, middle, box->computeInertia(mass)));
  body->createShapeNodeWith<dyn::CollisionAspect, dyn::DynamicsAspect>(box)->setRelativeTranslation(
      middle);
}

/// A skeleton of one box that moves freely. Others may be added to it.
dyn::BodyNode* AddFree(const Vector3d& sides, double mass, const Vector3d& middle,
                       const WorldPtr& world) {
  const auto skeleton = dyn::Skeleton::create("free " + std::to_string(world->getNumSkeletons()));
  dyn::BodyNode* const body = skeleton->createJointAndBodyNodePair<dyn::FreeJoint>().second;
  Shape(sides, mass, Vector3d::Zero(), body);
  for (int i = 0; i < 3; ++i) skeleton->setPosition(3 + i, middle[i]);
  world->addSkeleton(skeleton);
  return body;
}

/// The same, which does not move.
dyn::BodyNode* AddFixed(const Vector3d& sides, const Vector3d& middle, const WorldPtr& world) {
  const auto skeleton = dyn::Skeleton::create("fixed " + std::to_string(world->getNumSkeletons()));
  const auto [joint, body] = skeleton->createJointAndBodyNodePair<dyn::WeldJoint>();
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.translation() = middle;
  joint->setTransformFromParentBodyNode(place);
  Shape(sides, 1, Vector3d::Zero(), body);
  world->addSkeleton(skeleton);
  return body;
}

/// A box on a joint of @p parent, there at @p at; the joint is the origin of its frame.
template <class Joint>
dyn::BodyNode* Attach(const Vector3d& at, const Vector3d& sides, double mass,
                      const Vector3d& middle, dyn::BodyNode* parent) {
  const std::string name = std::to_string(parent->getSkeleton()->getNumBodyNodes());
  typename Joint::Properties properties;
  properties.mName = "joint " + name;
  const auto [joint, body] = parent->createChildJointAndBodyNodePair<Joint>(
      properties, dyn::BodyNode::AspectProperties("body " + name));
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.translation() = at;
  joint->setTransformFromParentBodyNode(place);
  Shape(sides, mass, middle, body);
  return body;
}

/// A world of one solver, and what is looked at in the end.
struct Scene {
  std::string what;
  std::function<std::function<double()>(const WorldPtr&)> build;  ///< returns what is looked at
  const char* fact;                                               ///< its name
  double expected, margin;                                        ///< of it [m]
  bool servos = false;                                            ///< hold the pose of the start
};

/// @param push  of every second box, sideways, at the start [m/s]
Scene Stack(int boxes, double push) {
  const auto build = [boxes, push](const WorldPtr& world) {
    AddFixed({20, 20, 1}, {0, 0, -0.5}, world);
    dyn::BodyNode* top = nullptr;
    for (int i = 0; i < boxes; ++i) {
      top = AddFree({0.5, 0.5, 0.5}, 1, {0, 0, 0.25 + 0.5 * i}, world);
      if (i % 2 == 1) top->getSkeleton()->setVelocity(3, push);
    }
    return [top] { return top->getTransform().translation().z() + 0.25; };
  };
  const std::string how = push > 0 ? ", every second one pushed" : " at rest";
  return {std::to_string(boxes) + " boxes" + how, build, "top at", 0.5 * boxes, 0.01};
}

/// 30 joint axes with servos that hold a man of 75 kg upright, each foot with toes.
Scene Humanoid() {
  const auto build = [](const WorldPtr& world) {
    AddFixed({20, 20, 1}, {0, 0, -0.5}, world);
    dyn::BodyNode* const pelvis = AddFree({0.2, 0.3, 0.2}, 12, {0, 0, 1}, world);
    const auto torso =
        Attach<dyn::EulerJoint>({0, 0, 0.1}, {0.2, 0.35, 0.5}, 28, {0, 0, 0.25}, pelvis);
    const auto head =
        Attach<dyn::EulerJoint>({0, 0, 0.5}, {0.18, 0.16, 0.26}, 5, {0, 0, 0.15}, torso);
    for (const double side : {-1.0, 1.0}) {
      const auto arm = Attach<dyn::EulerJoint>({0, 0.22 * side, 0.45}, {0.08, 0.08, 0.3}, 2,
                                               {0, 0, -0.15}, torso);
      Attach<dyn::RevoluteJoint>({0, 0, -0.3}, {0.07, 0.07, 0.3}, 1.5, {0, 0, -0.15}, arm);
      const auto thigh = Attach<dyn::EulerJoint>({0, 0.1 * side, -0.1}, {0.12, 0.12, 0.4}, 7,
                                                 {0, 0, -0.2}, pelvis);
      const auto shin =
          Attach<dyn::RevoluteJoint>({0, 0, -0.4}, {0.1, 0.1, 0.4}, 3.5, {0, 0, -0.2}, thigh);
      const auto heel =
          Attach<dyn::EulerJoint>({0, 0, -0.42}, {0.16, 0.1, 0.08}, 0.8, {0, 0, -0.04}, shin);
      Attach<dyn::RevoluteJoint>({0.09, 0, -0.04}, {0.14, 0.1, 0.08}, 0.2, {0.07, 0, 0}, heel);
    }
    return [head] { return head->getTransform().translation().z(); };
  };
  return {"humanoid on servos", build, "head at", 1.6, 0.02, true};
}

/// A ring of @p links on ball joints, which falls upright onto the ground. DART keeps trees: the
/// last joint is a constraint.
Scene Ring(int links) {
  const auto build = [links](const WorldPtr& world) {
    AddFixed({20, 20, 1}, {0, 0, -0.5}, world);
    const double length = 0.4, turn = 2 * std::acos(-1.0) / links;
    dyn::BodyNode* const first = AddFree({length, 0.08, 0.08}, 1, {0, 0, 0.1}, world);
    dyn::BodyNode* last = first;
    Vector3d end(length / 2, 0, 0);
    for (int i = 1; i < links; ++i, end = {length, 0, 0}) {
      last = Attach<dyn::BallJoint>(end, {length, 0.08, 0.08}, 1, {length / 2, 0, 0}, last);
      // about y, upwards
      last->getParentJoint()->setPosition(1, -turn);
    }
    const auto gap = [first, last, length] {
      return (last->getTransform() * Vector3d(length, 0, 0) -
              first->getTransform() * Vector3d(-length / 2, 0, 0))
          .norm();
    };
    const Vector3d closing = first->getTransform() * Vector3d(-length / 2, 0, 0);
    world->getConstraintSolver()->addConstraint(
        std::make_shared<dart::constraint::BallJointConstraint>(first, last, closing));
    return gap;
  };
  return {"a ring of " + std::to_string(links) + " links", build, "gap", 0, 0.01};
}

double Median(std::vector<double> numbers) {
  if (numbers.empty()) return 0;
  std::nth_element(numbers.begin(), numbers.begin() + numbers.size() / 2, numbers.end());
  return numbers[numbers.size() / 2];
}

/// Servos ask for the speed that takes their joint back to where it was.
void HoldPose(const WorldPtr& world) {
  for (size_t s = 0; s < world->getNumSkeletons(); ++s) {
    const dyn::SkeletonPtr skeleton = world->getSkeleton(s);
    for (size_t i = 6; i < skeleton->getNumDofs(); ++i) {
      skeleton->setCommand(i, -20 * skeleton->getPosition(i));
    }
  }
}

void MakeServos(const WorldPtr& world) {
  for (size_t s = 0; s < world->getNumSkeletons(); ++s) {
    const dyn::SkeletonPtr skeleton = world->getSkeleton(s);
    for (size_t j = 1; j < skeleton->getNumJoints(); ++j) {
      skeleton->getJoint(j)->setActuatorType(dyn::Joint::SERVO);
    }
    for (size_t i = 6; i < skeleton->getNumDofs(); ++i) {
      skeleton->setForceUpperLimit(i, 300);
      skeleton->setForceLowerLimit(i, -300);
    }
  }
}

/// What is looked at in the end.
double Run(const Scene& scene, const std::shared_ptr<Measured>& solver, int steps) {
  const WorldPtr world = dart::simulation::World::create();
  world->setGravity({0, 0, -9.81});
  world->setTimeStep(kStep);
  world->setConstraintSolver(
      std::make_unique<dart::constraint::BoxedLcpConstraintSolver>(solver, nullptr));
  world->getConstraintSolver()->setCollisionDetector(
      dart::collision::DARTCollisionDetector::create());
  const std::function<double()> fact = scene.build(world);
  if (scene.servos) MakeServos(world);
  for (int i = 0; i < steps; ++i) {
    if (scene.servos) HoldPose(world);
    world->step();
  }
  return fact();
}

}  // namespace

int main(int argc, char** argv) {
  const int steps = argc > 1 ? std::atoi(argv[1]) : 300;
  const Scene scenes[] = {Stack(5, 0),    Stack(10, 0), Stack(20, 0), Stack(5, 0.3),
                          Stack(10, 0.3), Humanoid(),   Ring(12),     Ring(24)};
  int failures = 0;
  for (const Scene& scene : scenes) {
    std::printf("%s\n", scene.what.c_str());
    const std::pair<const char*, std::shared_ptr<BoxedLcpSolver>> solvers[] = {
        {"Dantzig", std::make_shared<dart::constraint::DantzigBoxedLcpSolver>()},
        {"PGS", std::make_shared<dart::constraint::PgsBoxedLcpSolver>()},
        {"Cairn", std::make_shared<cairn::dart::BoxedLcpSolver>()}};
    for (const auto& [name, solver] : solvers) {
      const auto measured = std::make_shared<Measured>(solver);
      const double found = Run(scene, measured, steps);
      const std::vector<double>& residuals = measured->residuals;
      std::printf(
          "  %-8s %4d rows, %8.0f us, residual median %.1e, worst %.1e m/s, %d failed, %s %.3f m\n",
          name, measured->rows, Median(measured->microseconds), Median(residuals),
          *std::max_element(residuals.begin(), residuals.end()), measured->failed, scene.fact,
          found);
      const bool holds = std::abs(found - scene.expected) <= scene.margin;
      if (std::string(name) == "Cairn" && (!holds || measured->failed > 0)) ++failures;
    }
  }
  std::printf("%s\n", failures == 0 ? "Cairn held them all" : "Cairn let one fall");
  return failures;
}
