// SPDX-License-Identifier: MIT
#include "accuracy/tension/tension_world.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "scenes/facts.h"
#include "scenes/joints/joint_frames.h"

namespace cairn::accuracy {
namespace {

constexpr btScalar kLength = 1, kHeight = btScalar(0.2), kWidth = btScalar(0.1);  // of a link [m]
constexpr btScalar kRadius = btScalar(0.5);                                       // of a ball [m]
constexpr double kGravity = 9.81;
/// Of what would keep a chain level as it circles, the square root of gravity over length.
constexpr double kCircling = 0.5;

std::unique_ptr<btTypedConstraint> Cone(btRigidBody* a, btRigidBody* b, const btTransform& frame,
                                        bool limits) {
  auto cone = std::make_unique<btConeTwistConstraint>(*a, *b, bench::Local(*a, frame),
                                                      bench::Local(*b, frame));
  constexpr auto kMost = btScalar(TensionCell::kMostAngle);
  if (limits) cone->setLimit(kMost, kMost, kMost);
  return cone;
}

std::unique_ptr<btTypedConstraint> Hinge(btRigidBody* a, btRigidBody* b, const btTransform& frame,
                                         bool limits) {
  auto hinge =
      std::make_unique<btHingeConstraint>(*a, *b, bench::Local(*a, frame), bench::Local(*b, frame));
  constexpr auto kMost = btScalar(TensionCell::kMostAngle);
  if (limits) hinge->setLimit(-kMost, kMost);
  return hinge;
}

std::unique_ptr<btTypedConstraint> SixDof(btRigidBody* a, btRigidBody* b, const btTransform& frame,
                                          bool limits) {
  auto joint = std::make_unique<btGeneric6DofConstraint>(*a, *b, bench::Local(*a, frame),
                                                         bench::Local(*b, frame), true);
  joint->setLinearLowerLimit(btVector3(0, 0, 0));
  joint->setLinearUpperLimit(btVector3(0, 0, 0));
  // a lower limit above the upper one is none
  const btScalar most = limits ? btScalar(TensionCell::kMostAngle) : btScalar(-1);
  joint->setAngularLowerLimit(btVector3(-most, -most, -most));
  joint->setAngularUpperLimit(btVector3(most, most, most));
  return joint;
}

}  // namespace

std::string_view NameOf(Link link) {
  switch (link) {
    case Link::kPin:
      return "pin";
    case Link::kHinge:
      return "hinge";
    case Link::kConeTwist:
      return "cone-twist";
    case Link::kSixDof:
      break;
  }
  return "six-dof";
}

std::string_view NameOf(Stage stage) {
  switch (stage) {
    case Stage::kPlane:
      return "plane";
    case Stage::kSpace:
      return "space";
    case Stage::kFree:
      break;
  }
  return "free";
}

std::string GroupOf(const TensionCell& cell) {
  return fmt::format("{}, {}{}, {:g} Hz", NameOf(cell.stage), NameOf(cell.link),
                     cell.limits ? " with limits" : "", cell.rate);
}

std::string NameOf(const TensionCell& cell) {
  return fmt::format("{}: {} links under {:g}", GroupOf(cell), cell.links, cell.load);
}

TensionWorld::TensionWorld(const TensionCell& cell, btConstraintSolver* solver)
    : cell_(cell), world_(solver, btScalar(1 / cell.rate)) {
  const bool free = cell.stage == Stage::kFree;
  if (free) world_.bullet()->setGravity(btVector3(0, 0, 0));
  const auto at = [](double x) { return bench::At(btScalar(x), 0, 0); };
  btRigidBody* previous = free ? AddBall(0) : world_.AddSphere(kRadius, {.pose = at(0)});
  for (int i = 0; i < cell.links; ++i) {
    btRigidBody* const link =
        world_.AddBox(btVector3(kLength / 2, kHeight / 2, kWidth / 2),
                      {.mass = 1, .pose = at((i + 0.5) * static_cast<double>(kLength))});
    Join(previous, link, i);
    previous = link;
  }
  const btScalar end = kLength * btScalar(cell.links);
  ball_ = AddBall(end);
  Join(previous, ball_, cell.links);

  length_ = static_cast<double>(end);
  const double middle = length_ / 2, mass = cell.load;
  if (free) {
    // pulls as hard as the load would if it hung
    const auto rate = btScalar(std::sqrt(kGravity / middle));
    Spin(btVector3(btScalar(middle), 0, 0), btVector3(0, 0, rate));
    energy_scale_ = Energy();
    return;
  }
  energy_scale_ = kGravity * (middle * cell.links + length_ * mass);
  if (cell.stage == Stage::kPlane) {
    for (btRigidBody* body : world_.dynamic_bodies()) {
      body->setLinearFactor(btVector3(1, 1, 0));
      body->setAngularFactor(btVector3(0, 0, 1));
    }
    return;
  }
  Spin(btVector3(0, 0, 0), btVector3(0, btScalar(kCircling * std::sqrt(kGravity / length_)), 0));
}

btRigidBody* TensionWorld::AddBall(btScalar x) {
  return world_.AddSphere(kRadius, {.mass = btScalar(cell_.load), .pose = bench::At(x, 0, 0)});
}

void TensionWorld::Join(btRigidBody* a, btRigidBody* b, int place) {
  const btVector3 at(kLength * btScalar(place), 0, 0);
  const bool limits = cell_.limits && place > 0;
  // hinges of a chain in space turn about level and upright axes in turn
  const bool upright = cell_.stage != Stage::kPlane && place % 2 == 1;
  std::unique_ptr<btTypedConstraint> joint;
  // the pin takes no angular momentum about the vertical
  const bool pin = cell_.stage == Stage::kSpace && place == 0;
  switch (pin ? Link::kPin : cell_.link) {
    case Link::kPin:
      joint = std::make_unique<btPoint2PointConstraint>(
          *a, *b, bench::Local(*a, bench::At(at.x(), 0, 0)).getOrigin(),
          bench::Local(*b, bench::At(at.x(), 0, 0)).getOrigin());
      break;
    case Link::kHinge:
      joint = Hinge(a, b, bench::FrameAlongZ(at, btVector3(0, upright ? 1 : 0, upright ? 0 : 1)),
                    limits);
      break;
    case Link::kConeTwist:
      joint = Cone(a, b, bench::FrameAlongX(at, btVector3(1, 0, 0)), limits);
      break;
    case Link::kSixDof:
      joint = SixDof(a, b, bench::FrameAlongX(at, btVector3(1, 0, 0)), limits);
      break;
  }
  world_.AddJoint(std::move(joint), bench::ConnectedBodies::kPassThrough);
}

void TensionWorld::Spin(const btVector3& about, const btVector3& spin) {
  for (btRigidBody* body : world_.dynamic_bodies()) {
    body->setAngularVelocity(spin);
    body->setLinearVelocity(spin.cross(body->getCenterOfMassPosition() - about));
  }
}

double TensionWorld::Gap() const { return bench::LargestJointGap(world_); }

double TensionWorld::Energy() const { return bench::TotalEnergy(world_); }

btVector3 TensionWorld::Load() const { return ball_->getCenterOfMassPosition(); }

std::array<double, 3> TensionWorld::Spin() const {
  btVector3 about(0, 0, 0), drift(0, 0, 0);
  double mass = 0;
  if (cell_.stage == Stage::kFree) {
    for (const btRigidBody* body : world_.dynamic_bodies()) {
      about += body->getCenterOfMassPosition() * body->getMass();
      drift += body->getLinearVelocity() * body->getMass();
      mass += static_cast<double>(body->getMass());
    }
    about /= btScalar(mass);
    drift /= btScalar(mass);
  }
  std::array<double, 3> sum = {};
  for (const btRigidBody* body : world_.dynamic_bodies()) {
    const btVector3 arm = body->getCenterOfMassPosition() - about;
    const btVector3 own = body->getInvInertiaTensorWorld().inverse() * body->getAngularVelocity();
    const btVector3 whole = own + arm.cross(body->getLinearVelocity() - drift) * body->getMass();
    for (int k = 0; k < 3; ++k) sum[k] += static_cast<double>(whole[k]);
  }
  if (cell_.stage == Stage::kSpace) sum[0] = sum[2] = 0;
  return sum;
}

}  // namespace cairn::accuracy
