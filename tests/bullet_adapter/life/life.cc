// SPDX-License-Identifier: MIT
#include "tests/bullet_adapter/life/life.h"

#include <iterator>
#include <utility>

#include "scenes/world.h"
#include "tests/bullet_adapter/joint_world.h"

namespace cairn::test {
namespace {

using bench::At;

constexpr btScalar kTimeStep = btScalar(1) / 60;
constexpr double kHalfSide = 5;  // of the pit [m]
constexpr int kMostPieces = 50, kFewestPieces = 12, kMostLinks = 40;
constexpr int kForeignEvery = 500;  // frames
// of every so many frames the last ones are left in peace
constexpr int kPeriod = 900, kPeace = 400;

btTransform Relative(const btRigidBody& body, const btTransform& world) {
  return body.getWorldTransform().inverse() * world;
}

}  // namespace

Life::Life(std::uint64_t seed, WatchedSolver* solver) : random_(seed), solver_(solver) {
  world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, solver,
                                                     &configuration_);
  world_->setGravity({0, btScalar(-9.81), 0});
  BuildPit();
}

Life::~Life() {
  while (!links_.empty()) RemoveLink(static_cast<int>(links_.size()) - 1);
  while (!pieces_.empty()) RemovePiece(static_cast<int>(pieces_.size()) - 1);
  for (const auto& body : pit_) world_->removeRigidBody(body.get());
}

void Life::BuildPit() {
  const auto side = static_cast<btScalar>(kHalfSide);
  const auto add = [this](const btVector3& half_extents, const btTransform& pose) {
    pit_shapes_.push_back(std::make_unique<btBoxShape>(half_extents));
    btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, pit_shapes_.back().get());
    info.m_startWorldTransform = pose;
    pit_.push_back(std::make_unique<btRigidBody>(info));
    world_->addRigidBody(pit_.back().get());
  };
  add({side + 4, 2, side + 4}, At(0, -2, 0));
  for (const btScalar sign : {btScalar(-1), btScalar(1)}) {
    add({2, 10, side + 4}, At(sign * (side + 2), 10, 0));
    add({side + 4, 10, 2}, At(0, 10, sign * (side + 2)));
  }
}

btCollisionShape* Life::AddShape(Piece* piece) {
  const int kind = Below(3);
  const btVector3 sides(Between(0.15, 0.5), Between(0.15, 0.5), Between(0.15, 0.5));
  if (kind == 0) {
    piece->shapes.push_back(std::make_unique<btSphereShape>(sides.x()));
  } else {
    piece->shapes.push_back(std::make_unique<btBoxShape>(sides));
  }
  if (kind == 2) {
    auto compound = std::make_unique<btCompoundShape>();
    compound->addChildShape(At(-sides.x(), 0, 0), piece->shapes[0].get());
    piece->shapes.push_back(std::make_unique<btSphereShape>(sides.y()));
    compound->addChildShape(At(sides.x(), 0, 0), piece->shapes[1].get());
    piece->shapes.push_back(std::move(compound));
  }
  return piece->shapes.back().get();
}

btRigidBody* Life::AddBody(const btTransform& pose) {
  auto piece = std::make_unique<Piece>();
  btCollisionShape* const shape = AddShape(piece.get());
  const btScalar mass = Between(0.2, 10);
  btVector3 inertia;
  shape->calculateLocalInertia(mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
  info.m_startWorldTransform = pose;
  info.m_friction = Between(0, 1.2);
  if (Chance(0.2)) info.m_restitution = Between(0, 0.8);
  if (Chance(0.3)) info.m_rollingFriction = Between(0, 0.1);
  if (Chance(0.3)) info.m_spinningFriction = Between(0, 0.1);
  piece->body = std::make_unique<btRigidBody>(info);
  btRigidBody* const body = piece->body.get();
  if (Chance(0.1)) body->setAnisotropicFriction({1, btScalar(0.5), btScalar(0.2)});
  if (Chance(0.1)) body->setContactStiffnessAndDamping(5000, 50);
  if (Chance(0.1)) body->setAngularFactor({0, 1, 0});
  if (Chance(0.1)) body->setCcdMotionThreshold(btScalar(0.1));
  if (Chance(0.1)) body->setCcdSweptSphereRadius(btScalar(0.1));
  body->setLinearVelocity(random_.InCube(2));
  body->setAngularVelocity(random_.InCube(3));
  pieces_.push_back(std::move(piece));
  world_->addRigidBody(body);
  ++facts_.bodies_added;
  return body;
}

void Life::AddLink(std::unique_ptr<btTypedConstraint> joint) {
  // a joint that wants to turn a body about a locked axis can only be violated, as far as it likes
  for (btRigidBody* body : {&joint->getRigidBodyA(), &joint->getRigidBodyB()}) {
    if (body->isInWorld()) body->setAngularFactor(1);
  }
  Link link;
  link.joint = std::move(joint);
  if (Chance(0.5)) {
    link.feedback = std::make_unique<btJointFeedback>();
    link.joint->setJointFeedback(link.feedback.get());
  }
  if (Chance(0.2)) link.joint->setBreakingImpulseThreshold(Between(1, 20));
  if (Chance(0.1)) link.joint->setOverrideNumSolverIterations(1 + Below(30));
  world_->addConstraint(link.joint.get(), Chance(0.7));
  links_.push_back(std::move(link));
  ++facts_.joints_added;
}

/// A new body where a joint of a random kind wants it.
void Life::AddLimb() {
  btRigidBody* const above = AnyPiece()->body.get();
  btRigidBody* const below = AddBody(above->getWorldTransform() * At(0, btScalar(-1.2), 0));
  const auto& kinds = JointKinds();
  AddLink(kinds[Below(static_cast<int>(kinds.size()))].make(above, below));
}

/// Joins bodies where they are: two of them, or one to the world.
void Life::Tie() {
  btRigidBody &a = *AnyPiece()->body, &b = *AnyPiece()->body;
  const btTransform middle(
      btQuaternion::getIdentity(),
      (a.getWorldTransform().getOrigin() + b.getWorldTransform().getOrigin()) / 2);
  const btTransform in_a = Relative(a, middle), in_b = Relative(b, middle);
  const int kind = Below(3);
  if (&a == &b) {
    AddLink(std::make_unique<btPoint2PointConstraint>(a, btVector3(0, btScalar(0.2), 0)));
  } else if (kind == 0) {
    AddLink(std::make_unique<btPoint2PointConstraint>(a, b, in_a.getOrigin(), in_b.getOrigin()));
  } else if (kind == 1) {
    AddLink(std::make_unique<btFixedConstraint>(a, b, in_a, in_b));
  } else {
    AddLink(std::make_unique<btHingeConstraint>(a, b, in_a, in_b));
  }
}

void Life::AddForeign() {
  auto joint =
      std::make_unique<btPoint2PointConstraint>(*AnyPiece()->body, btVector3(0, btScalar(0.1), 0));
  joint->m_objectType = MAX_CONSTRAINT_TYPE;
  AddLink(std::move(joint));
}

void Life::RemoveLink(int index) {
  world_->removeConstraint(links_[index].joint.get());
  links_.erase(links_.begin() + index);
  ++facts_.joints_removed;
}

void Life::RemovePiece(int index) {
  const btRigidBody* const body = pieces_[index]->body.get();
  for (int i = static_cast<int>(links_.size()) - 1; i >= 0; --i) {
    const btTypedConstraint& joint = *links_[i].joint;
    if (&joint.getRigidBodyA() == body || &joint.getRigidBodyB() == body) RemoveLink(i);
  }
  world_->removeRigidBody(pieces_[index]->body.get());
  pieces_.erase(pieces_.begin() + index);
  ++facts_.bodies_removed;
}

/// Sometimes to nothing, which makes the body static.
void Life::ChangeMass() {
  Piece* const piece = AnyPiece();
  if (piece->kinematic()) return;
  btRigidBody* const body = piece->body.get();
  const btScalar mass = Chance(0.1) ? btScalar(0) : Between(0.1, 40);
  btVector3 inertia(0, 0, 0);
  if (mass > 0) body->getCollisionShape()->calculateLocalInertia(mass, inertia);
  world_->removeRigidBody(body);
  body->setMassProps(mass, inertia);
  body->updateInertiaTensor();
  body->setLinearVelocity({0, 0, 0});
  body->setAngularVelocity({0, 0, 0});
  world_->addRigidBody(body);
  body->activate(true);
}

/// A kinematic body keeps its mass, as happens in games.
void Life::ToggleKinematic() {
  Piece* const piece = AnyPiece();
  btRigidBody* const body = piece->body.get();
  if (body->isStaticObject()) return;
  const int flags = body->getCollisionFlags();
  world_->removeRigidBody(body);
  body->setCollisionFlags(flags ^ btCollisionObject::CF_KINEMATIC_OBJECT);
  body->setLinearVelocity({0, 0, 0});
  body->setAngularVelocity({0, 0, 0});
  world_->addRigidBody(body);
  body->forceActivationState(piece->kinematic() ? DISABLE_DEACTIVATION : ACTIVE_TAG);
  piece->drift = random_.InCube(0.5);
}

void Life::ChangeLink() {
  if (links_.empty()) return;
  Link& link = links_[Below(static_cast<int>(links_.size()))];
  link.joint->setEnabled(Chance(0.7));
  link.was_enabled = link.joint->isEnabled();
}

void Life::ChangeSolver() {
  btContactSolverInfo& info = world_->getSolverInfo();
  info.m_numIterations = 4 + Below(20);
  info.m_splitImpulse = Below(2);
  info.m_minimumSolverBatchSize = Chance(0.5) ? 1 : 128;
  info.m_globalCfm = Chance(0.2) ? btScalar(1e-5) : btScalar(0);
  info.m_solverMode = SOLVER_SIMD;
  if (Chance(0.9)) info.m_solverMode |= SOLVER_USE_WARMSTARTING;
  if (Chance(0.5)) info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  if (Chance(0.2)) info.m_solverMode |= SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
  if (Chance(0.2)) info.m_solverMode |= SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION;

  Settings& settings = solver_->settings();
  settings.k_sm = Below(3);
  settings.step_policy = Chance(0.2) ? StepPolicy::kAlways : StepPolicy::kMeasured;
  settings.threads = 1 + Below(2);
  settings.budget = Chance(0.3) ? Budget::Work(1000 * Below(1000)) : Budget::Unlimited();
  bullet::Options& options = solver_->options();
  options.mode = Chance(0.1) ? bullet::Mode::kReference : bullet::Mode::kFast;
  options.contacts = Chance(0.2) ? bullet::ContactForm::kRows : bullet::ContactForm::kManifolds;
  options.warm_start_friction = Chance(0.8);
  options.warm_start_joints = Chance(0.8);
  if (Chance(0.2)) solver_->reset();
}

void Life::Disturb() {
  const int pieces = static_cast<int>(pieces_.size());
  if (pieces < kFewestPieces || (pieces < kMostPieces && Chance(0.1))) {
    AddBody(btTransform(btQuaternion(Between(-3, 3), Between(-3, 3), Between(-3, 3)),
                        btVector3(0, 6, 0) + random_.InCube(3)));
  }
  if (pieces > kFewestPieces && Chance(0.06)) RemovePiece(Below(pieces));
  if (pieces < kFewestPieces) return;
  const int links = static_cast<int>(links_.size());
  if (links < kMostLinks && pieces < kMostPieces && Chance(0.06)) AddLimb();
  if (links < kMostLinks && Chance(0.02)) Tie();
  // chance alone leaves them out of some lives
  if (frame_ % kForeignEvery == kForeignEvery / 2) AddForeign();
  if (links > 0 && Chance(0.06)) RemoveLink(Below(links));
  if (Chance(0.02)) ChangeMass();
  if (Chance(0.02)) ToggleKinematic();
  if (Chance(0.03)) ChangeLink();
  if (Chance(0.02)) ChangeSolver();
  if (Chance(0.05)) {
    btRigidBody* const body = AnyPiece()->body.get();
    body->activate(true);
    if (!body->isStaticOrKinematicObject()) body->setLinearVelocity(random_.InCube(5));
  }
}

/// To and fro, a second each way.
void Life::MoveKinematic() {
  const btScalar sign = frame_ / 60 % 2 == 0 ? btScalar(1) : btScalar(-1);
  for (const auto& piece : pieces_) {
    if (!piece->kinematic()) continue;
    btTransform pose = piece->body->getWorldTransform();
    pose.setOrigin(pose.getOrigin() + piece->drift * (sign * kTimeStep));
    piece->body->setWorldTransform(pose);
  }
}

/// What was squeezed through the ground, or thrown over the walls.
void Life::RemoveLost() {
  for (int i = static_cast<int>(pieces_.size()) - 1; i >= 0; --i) {
    const btVector3& at = pieces_[i]->body->getWorldTransform().getOrigin();
    if (at.y() < -3 || at.length() > 30) RemovePiece(i);
  }
}

void Life::Frame() {
  if (frame_ % kPeriod < kPeriod - kPeace) Disturb();
  MoveKinematic();
  if (frame_ % 7 == 0) {
    world_->stepSimulation(kTimeStep, 2, kTimeStep / 2);
  } else {
    world_->stepSimulation(kTimeStep, 0);
  }
  Observe();
  RemoveLost();
  ++frame_;
}

}  // namespace cairn::test
