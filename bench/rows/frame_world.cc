// SPDX-License-Identifier: MIT
#include "rows/frame_world.h"

#include <utility>

#include "rows/row_solvers.h"

namespace cairn::cli {
namespace {

btVector3 Convert(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}
btVector3 Convert(const float* v) { return {v[0], v[1], v[2]}; }

btScalar TimeStepOf(const RowProblem& problem) {
  const double step = problem.frame.time_step;
  return step > 0 ? static_cast<btScalar>(step) : btScalar(1) / 60;
}

btTransform PoseOf(const FrameLayout::Box& box) {
  btTransform pose;
  pose.setOrigin(Convert(box.centre));
  const Eigen::Matrix3d& m = box.axes;
  const auto at = [&m](int row, int column) { return static_cast<btScalar>(m(row, column)); };
  pose.setBasis(
      {at(0, 0), at(0, 1), at(0, 2), at(1, 0), at(1, 1), at(1, 2), at(2, 0), at(2, 1), at(2, 2)});
  return pose;
}

}  // namespace

FrameWorld::FrameWorld(std::shared_ptr<const RowProblem> problem, btConstraintSolver* host)
    : problem_(std::move(problem)), world_(host, TimeStepOf(*problem_)) {
  const FrameLayout layout = LayOut(*problem_);
  ground_ = world_.AddGround(static_cast<btScalar>(layout.ground));
  for (const FrameLayout::Box& box : layout.boxes) {
    bodies_.push_back(world_.AddBox(
        Convert(box.half), {.mass = static_cast<btScalar>(box.mass), .pose = PoseOf(box)}));
    bodies_.back()->setUserIndex(static_cast<int>(bodies_.size()) - 1);
    bodies_.back()->setIslandTag(box.group);
  }
  AddContacts();
  AddJoints(layout);
}

FrameWorld::~FrameWorld() {
  for (btPersistentManifold* manifold : manifolds_) {
    world_.bullet()->getDispatcher()->releaseManifold(manifold);
  }
}

void FrameWorld::AddContacts() {
  for (const Manifold& manifold : problem_->frame.manifolds) {
    btRigidBody &a = *BodyOf(manifold.body_a), &b = *BodyOf(manifold.body_b);
    manifolds_.push_back(world_.bullet()->getDispatcher()->getNewManifold(&a, &b));
    for (int i = 0; i < manifold.points; ++i) {
      const ContactPoint& point = problem_->frame.points[manifold.first_point + i];
      const btVector3 at = manifold.body_a != kWorld
                               ? a.getCenterOfMassPosition() + Convert(point.arm_a)
                               : b.getCenterOfMassPosition() + Convert(point.arm_b);
      btManifoldPoint shown(a.getCenterOfMassTransform().invXform(at),
                            b.getCenterOfMassTransform().invXform(at), Convert(point.normal), 0);
      shown.m_positionWorldOnA = shown.m_positionWorldOnB = at;
      manifolds_.back()->addManifoldPoint(shown);
    }
  }
}

void FrameWorld::AddJoints(const FrameLayout& layout) {
  for (const FrameLayout::Anchors& joint : layout.joints) {
    btRigidBody &a = *BodyOf(joint.body_a), &b = *BodyOf(joint.body_b);
    world_.AddJoint(std::make_unique<btPoint2PointConstraint>(
                        a, b, a.getCenterOfMassTransform().invXform(Convert(joint.a)),
                        b.getCenterOfMassTransform().invXform(Convert(joint.b))),
                    bench::ConnectedBodies::kCollide);
  }
}

bool FrameWorld::Use(const SolverEntry& entry) {
  if (used_ == &entry) return solver_ != nullptr;
  used_ = &entry;
  cairn_ = nullptr;
  solver_ = nullptr;
  if (entry.maker == Maker::kCairn) {
    auto made = std::make_unique<CairnRowSolver>();
    cairn_ = made.get();
    solver_ = std::move(made);
    return true;
  }
  for (const RowSolverEntry& known : RowSolvers()) {
    if (known.name == entry.name) solver_ = known.make({});
  }
  return solver_ != nullptr;
}

std::string FrameWorld::Solve(const SolverEntry& entry, const Settings& settings,
                              const RowLimit& limit) {
  if (!Use(entry)) return entry.name + " solves no recordings";
  if (cairn_ != nullptr) cairn_->settings() = settings;
  if (std::string why = solver_->Prepare(*problem_); !why.empty()) return why;
  const auto begin = std::chrono::steady_clock::now();
  solver_->IterateUntil(limit);
  time_ = std::chrono::steady_clock::now() - begin;
  outcome_ = solver_->Result();
  if (outcome_.failure.empty()) Show();
  return outcome_.failure;
}

double FrameWorld::Residual() const {
  return Measure(problem_->rows.problem(), outcome_.impulses).residual_max;
}

std::optional<IslandReport> FrameWorld::ReportOf(const btRigidBody& body) const {
  const auto index = static_cast<size_t>(body.getUserIndex());
  if (cairn_ == nullptr || index >= cairn_->report().island_of.size()) return {};
  const int island = cairn_->report().island_of[index];
  if (island < 0) return {};
  return cairn_->report().islands[island];
}

void FrameWorld::Show() {
  const auto& motions = problem_->frame.motions;
  for (size_t i = 0; i < bodies_.size(); ++i) {
    btVector3 linear = Convert(outcome_.velocities[i].linear),
              angular = Convert(outcome_.velocities[i].angular);
    if (!motions.empty()) {  // velocities are counted from there
      linear += Convert(motions[i].free_velocity);
      angular += Convert(motions[i].free_spin);
    }
    bodies_[i]->setLinearVelocity(linear);
    bodies_[i]->setAngularVelocity(angular);
  }
  // rows of a manifold: normals of its points, then the friction of each
  auto row = static_cast<size_t>(problem_->first_contact);
  for (size_t m = 0; m < manifolds_.size(); ++m) {
    const Manifold& manifold = problem_->frame.manifolds[m];
    for (int i = 0; i < manifold.points; ++i) {
      btManifoldPoint& point = manifolds_[m]->getContactPoint(i);
      point.m_appliedImpulse = static_cast<btScalar>(outcome_.impulses[row + i]);
      const auto friction = [&](int direction, btVector3* along, btScalar* impulse) {
        if (direction >= manifold.tangents) return;
        const size_t place = row + manifold.points + i * manifold.tangents + direction;
        *along = Convert(problem_->rows.rows[place].linear_a);
        *impulse = static_cast<btScalar>(outcome_.impulses[place]);
      };
      friction(0, &point.m_lateralFrictionDir1, &point.m_appliedImpulseLateral1);
      friction(1, &point.m_lateralFrictionDir2, &point.m_appliedImpulseLateral2);
    }
    row += static_cast<size_t>(manifold.rows());
  }
}

}  // namespace cairn::cli
