// SPDX-License-Identifier: MIT
// Boxes stacked in DART: its Dantzig and PGS solvers and Cairn on the same problems, one world
// each.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <dart/collision/dart/DARTCollisionDetector.hpp>
#include <dart/constraint/BoxedLcpConstraintSolver.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/constraint/DantzigBoxedLcpSolver.hpp>
#include <dart/constraint/PgsBoxedLcpSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/ShapeNode.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>
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

dart::dynamics::SkeletonPtr MakeBox(const std::string& name, const Eigen::Vector3d& sides,
                                    double mass, double height) {
  const auto skeleton = dart::dynamics::Skeleton::create(name);
  const auto shape = std::make_shared<dart::dynamics::BoxShape>(sides);
  dart::dynamics::BodyNode* body = nullptr;
  if (mass > 0) {
    body = skeleton->createJointAndBodyNodePair<dart::dynamics::FreeJoint>().second;
    dart::dynamics::Inertia inertia;
    inertia.setMass(mass);
    inertia.setMoment(shape->computeInertia(mass));
    body->setInertia(inertia);
    skeleton->setPosition(5, height);
  } else {
    const auto pair = skeleton->createJointAndBodyNodePair<dart::dynamics::WeldJoint>();
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    place.translation().z() = height;
    pair.first->setTransformFromParentBodyNode(place);
    body = pair.second;
  }
  body->createShapeNodeWith<dart::dynamics::CollisionAspect, dart::dynamics::DynamicsAspect>(shape);
  return skeleton;
}

double Median(std::vector<double> numbers) {
  if (numbers.empty()) return 0;
  std::nth_element(numbers.begin(), numbers.begin() + numbers.size() / 2, numbers.end());
  return numbers[numbers.size() / 2];
}

struct Outcome {
  std::shared_ptr<Measured> solver;
  double height;  ///< of the top
};

/// @param push  of every second box, sideways, at the start [m/s]
Outcome Run(const std::shared_ptr<BoxedLcpSolver>& solver, int boxes, double push, int steps) {
  const auto world = dart::simulation::World::create();
  world->setGravity({0, 0, -9.81});
  world->setTimeStep(1e-3);
  const auto measured = std::make_shared<Measured>(solver);
  world->setConstraintSolver(
      std::make_unique<dart::constraint::BoxedLcpConstraintSolver>(measured, nullptr));
  world->getConstraintSolver()->setCollisionDetector(
      dart::collision::DARTCollisionDetector::create());
  world->addSkeleton(MakeBox("ground", {20, 20, 1}, 0, -0.5));
  for (int i = 0; i < boxes; ++i) {
    world->addSkeleton(MakeBox("box" + std::to_string(i), {0.5, 0.5, 0.5}, 1, 0.25 + 0.5 * i));
    if (i % 2 == 1) world->getSkeleton(i + 1)->setVelocity(3, push);
  }
  for (int i = 0; i < steps; ++i) world->step();
  return {measured, world->getSkeleton(boxes)->getPosition(5) + 0.25};
}

}  // namespace

int main(int argc, char** argv) {
  const int steps = argc > 1 ? std::atoi(argv[1]) : 300;
  int failures = 0;
  const std::pair<int, double> stacks[] = {{5, 0}, {10, 0}, {20, 0}, {5, 0.3}, {10, 0.3}};
  for (const auto& [boxes, push] : stacks) {
    std::printf("%d boxes, %.1f m high, every second one pushed with %.1f m/s\n", boxes,
                0.5 * boxes, push);
    const std::pair<const char*, std::shared_ptr<BoxedLcpSolver>> solvers[] = {
        {"Dantzig", std::make_shared<dart::constraint::DantzigBoxedLcpSolver>()},
        {"PGS", std::make_shared<dart::constraint::PgsBoxedLcpSolver>()},
        {"Cairn", std::make_shared<cairn::dart::BoxedLcpSolver>()}};
    for (const auto& [name, solver] : solvers) {
      const auto [measured, height] = Run(solver, boxes, push, steps);
      const double worst =
          *std::max_element(measured->residuals.begin(), measured->residuals.end());
      std::printf(
          "  %-8s %4d rows, %8.0f us, residual median %.1e, worst %.1e m/s, %d failed, top "
          "at %.3f m\n",
          name, measured->rows, Median(measured->microseconds), Median(measured->residuals), worst,
          measured->failed, height);
      const bool stands = std::abs(height - 0.5 * boxes) < 0.01;
      if (std::string(name) == "Cairn" && (!stands || measured->failed > 0)) ++failures;
    }
  }
  std::printf("%s\n", failures == 0 ? "Cairn held them all" : "Cairn let one fall");
  return failures;
}
