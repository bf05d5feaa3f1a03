// SPDX-License-Identifier: MIT
// What happens to the bodies and joints of a WorldGame.
#include <iterator>
#include <utility>

#include "tests/bullet_adapter/joint_world.h"
#include "tests/fuzz/world_game.h"

namespace cairn::test {
namespace {

/// As many numbers as there once were, so that inputs kept from then mean what they meant.
constexpr Path kPaths[] = {Path::kAuto, Path::kReference, Path::kReference, Path::kReference,
                           Path::kFast};

constexpr size_t kMostBodies = 14, kMostJoints = 14;
constexpr btScalar kExtremeMasses[] = {btScalar(1e-20), btScalar(1e20), btScalar(1e-6),
                                       btScalar(1e6)};
constexpr btScalar kMostOfAFineBody = btScalar(1e12);  // squares of m, m/s, rad/s, 1/(kg m^2)
/// Boxes in a pile that is worth threads.
constexpr int kSide = 8, kHeight = 6;

}  // namespace

btScalar WorldGame::Mass() {
  const int kind = choices_.Below(8);
  if (kind < 4) return 1;
  if (kind == 4) return 0;
  if (kind == 5) return kExtremeMasses[choices_.Below(4)];
  return Positive();
}

btVector3 WorldGame::Inertia(const btCollisionShape& shape, btScalar mass) {
  btVector3 inertia(0, 0, 0);
  if (mass == 0) return inertia;
  shape.calculateLocalInertia(mass, inertia);
  const int kind = choices_.Below(12);
  if (kind == 9) inertia[choices_.Below(3)] = 0;
  if (kind == 10) inertia.setZero();
  if (kind == 11) inertia = choices_.OneIn(8) ? Vector() : Vector().absolute();
  return inertia;
}

btTransform WorldGame::Pose() {
  const btScalar x = btScalar(2 * choices_.Unit()), z = btScalar(2 * choices_.Unit());
  btTransform pose = btTransform::getIdentity();
  pose.setOrigin({x, 1 + btScalar(choices_.Unit()), z});
  if (choices_.OneIn(2)) {
    const btVector3 axis(btScalar(choices_.Unit()), 1, btScalar(choices_.Unit()));
    pose.setRotation(btQuaternion(axis, btScalar(3 * choices_.Unit())));
  }
  return pose;
}

btRigidBody* WorldGame::Place(Piece piece, btScalar mass, const btVector3& inertia,
                              const btTransform& pose) {
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, piece.shapes.back().get(), inertia);
  info.m_startWorldTransform = pose;
  piece.body = std::make_unique<btRigidBody>(info);
  btRigidBody* const body = piece.body.get();
  pieces_.push_back(std::move(piece));
  world_->addRigidBody(body);
  return body;
}

void WorldGame::AddGround() {
  Piece piece;
  piece.shapes.push_back(std::make_unique<btBoxShape>(btVector3(20, 1, 20)));
  btTransform pose = btTransform::getIdentity();
  pose.setOrigin({0, -1, 0});
  Place(std::move(piece), 0, {0, 0, 0}, pose);
}

void WorldGame::AddPile() {
  const btVector3 half(btScalar(0.5), btScalar(0.5), btScalar(0.5));
  for (int i = 0; i < kSide * kSide * kHeight; ++i) {
    Piece piece;
    piece.shapes.push_back(std::make_unique<btBoxShape>(half));
    const int column = i / kHeight;
    btTransform pose = btTransform::getIdentity();
    pose.setOrigin({btScalar(1.2) * btScalar(column % kSide - kSide / 2),
                    btScalar(0.5) + btScalar(i % kHeight),
                    btScalar(1.2) * btScalar(column / kSide - kSide / 2)});
    Place(std::move(piece), 1, half / 3, pose);
  }
}

void WorldGame::AddBody() {
  if (pieces_.size() >= kMostBodies) return;
  Piece piece;
  const auto side = [this] { return btScalar(0.5 + 0.4 * choices_.Unit()); };
  switch (choices_.Below(4)) {
    case 0:
      piece.shapes.push_back(std::make_unique<btSphereShape>(side()));
      break;
    case 1: {
      const btScalar radius = side();
      piece.shapes.push_back(std::make_unique<btCapsuleShape>(radius, side()));
      break;
    }
    case 2: {
      piece.shapes.push_back(std::make_unique<btSphereShape>(side()));
      auto compound = std::make_unique<btCompoundShape>();
      btTransform at = btTransform::getIdentity();
      at.setOrigin({side(), 0, 0});
      compound->addChildShape(at, piece.shapes[0].get());
      compound->addChildShape(at.inverse(), piece.shapes[0].get());
      piece.shapes.push_back(std::move(compound));
      break;
    }
    default: {
      const btScalar x = side(), y = side();
      piece.shapes.push_back(std::make_unique<btBoxShape>(btVector3(x, y, side())));
    }
  }
  const btScalar mass = Mass();
  const btVector3 inertia = Inertia(*piece.shapes.back(), mass);
  btRigidBody* const body = Place(std::move(piece), mass, inertia, Pose());
  body->setLinearVelocity(Vector());
  body->setAngularVelocity(Vector());
}

void WorldGame::RemoveBody(int index) {
  const btRigidBody* const body = pieces_[index].body.get();
  for (int i = static_cast<int>(links_.size()) - 1; i >= 0; --i) {
    const btTypedConstraint& joint = *links_[i].joint;
    if (&joint.getRigidBodyA() == body || &joint.getRigidBodyB() == body) RemoveJoint(i);
  }
  world_->removeRigidBody(pieces_[index].body.get());
  pieces_.erase(pieces_.begin() + index);
}

void WorldGame::AddJoint() {
  if (links_.size() >= kMostJoints || empty()) return;
  Link link;
  btRigidBody &a = AnyBody(), &b = AnyBody();
  const auto& kinds = JointKinds();
  const JointKind& kind = kinds[choices_.Below(static_cast<int>(kinds.size()))];
  if (&a == &b) {
    const btVector3 pivot = Vector();
    link.joint = std::make_unique<btPoint2PointConstraint>(a, pivot);
  } else {
    link.joint = kind.make(&a, &b);
  }
  if (choices_.OneIn(16)) link.joint->m_objectType = MAX_CONSTRAINT_TYPE;  // of no known type
  if (choices_.OneIn(2)) {
    link.feedback = std::make_unique<btJointFeedback>();
    link.joint->setJointFeedback(link.feedback.get());
  }
  world_->addConstraint(link.joint.get(), choices_.OneIn(2));
  links_.push_back(std::move(link));
}

/// As a user does whose world has gone astray; what stays must go on.
void WorldGame::RemoveBad() {
  while (!links_.empty()) RemoveJoint(0);
  for (int i = static_cast<int>(pieces_.size()) - 1; i >= 0; --i) {
    const btRigidBody& body = *pieces_[i].body;
    const btVector3 &at = body.getWorldTransform().getOrigin(), &speed = body.getLinearVelocity();
    const btVector3 &spin = body.getAngularVelocity(), &inverse = body.getInvInertiaDiagLocal();
    const btScalar largest = at.length2() + speed.length2() + spin.length2() + inverse.length2();
    const bool is_fine = largest < kMostOfAFineBody && inverse[inverse.minAxis()] >= 0;
    if (!is_fine) RemoveBody(i);
  }
}

void WorldGame::RemoveJoint(int index) {
  world_->removeConstraint(links_[index].joint.get());
  links_.erase(links_.begin() + index);
}

void WorldGame::ChangeJoint() {
  if (links_.empty()) return;
  btTypedConstraint& joint = *links_[choices_.Below(static_cast<int>(links_.size()))].joint;
  const auto set = [&](int param) {
    const int axis = choices_.Below(6);
    const auto type = joint.getConstraintType();
    // the only ones that take any axis without a complaint
    const bool any_axis = type == D6_CONSTRAINT_TYPE || type == D6_SPRING_CONSTRAINT_TYPE ||
                          type == D6_SPRING_2_CONSTRAINT_TYPE;
    if (any_axis) {
      joint.setParam(param, Real(), axis);
    } else if (type == POINT2POINT_CONSTRAINT_TYPE) {
      joint.setParam(param, Real(), -1);
    }
  };
  switch (choices_.Below(6)) {
    case 0:
      return joint.setEnabled(!joint.isEnabled());
    case 1:
      return joint.setBreakingImpulseThreshold(Real());
    case 2:
      return joint.setOverrideNumSolverIterations(choices_.Below(40) - 1);
    case 3:
      return set(BT_CONSTRAINT_STOP_CFM);
    case 4:
      return set(choices_.OneIn(2) ? BT_CONSTRAINT_ERP : BT_CONSTRAINT_STOP_ERP);
    default:
      return set(BT_CONSTRAINT_CFM);
  }
}

void WorldGame::ChangeMotion() {
  btRigidBody& body = AnyBody();
  body.activate(true);
  switch (choices_.Below(6)) {
    case 0:
      return body.setLinearVelocity(Vector());
    case 1:
      return body.setAngularVelocity(Vector());
    case 2:
      return body.applyCentralForce(Vector());
    case 3:
      return body.applyTorque(Vector());
    case 4: {
      const btVector3 impulse = Vector();
      return body.applyImpulse(impulse, Vector());
    }
    default: {
      btTransform pose = Pose();
      if (choices_.OneIn(4)) pose.setOrigin(Vector());
      body.setWorldTransform(pose);
    }
  }
}

/// Without taking the body out of the world, which it is told to do, too, every other time.
void WorldGame::ChangeMass() {
  btRigidBody& body = AnyBody();
  const bool readded = choices_.OneIn(2);
  const btScalar mass = Mass();
  const btVector3 inertia = Inertia(*body.getCollisionShape(), mass);
  if (readded) world_->removeRigidBody(&body);
  body.setMassProps(mass, inertia);
  body.updateInertiaTensor();
  if (readded) world_->addRigidBody(&body);
}

void WorldGame::ChangeKind() {
  btRigidBody& body = AnyBody();
  const bool readded = choices_.OneIn(2);
  if (readded) world_->removeRigidBody(&body);
  body.setCollisionFlags(body.getCollisionFlags() ^ btCollisionObject::CF_KINEMATIC_OBJECT);
  if (readded) world_->addRigidBody(&body);
  if (choices_.OneIn(2)) body.forceActivationState(DISABLE_DEACTIVATION);
}

void WorldGame::ChangeSurface() {
  btRigidBody& body = AnyBody();
  switch (choices_.Below(7)) {
    case 0:
      return body.setFriction(Real());
    case 1:
      return body.setRestitution(Real());
    case 2:
      return body.setRollingFriction(Real());
    case 3:
      return body.setSpinningFriction(Real());
    case 4: {
      const btScalar stiffness = Real();
      return body.setContactStiffnessAndDamping(stiffness, Real());
    }
    case 5:
      return body.setAnisotropicFriction(Vector(), 1 + choices_.Below(3));
    default:
      body.setRestitution(1);
      body.setFriction(0);
  }
}

void WorldGame::ChangeSleep() {
  btRigidBody& body = AnyBody();
  switch (choices_.Below(4)) {
    case 0:
      body.setSleepingThresholds(100, 100);
      return body.setDeactivationTime(10);
    case 1:
      return body.forceActivationState(1 + choices_.Below(5));
    case 2:
      return body.activate(true);
    default: {
      const btScalar linear = Real();
      return body.setDamping(linear, Real());
    }
  }
}

void WorldGame::ChangeFactors() {
  btRigidBody& body = AnyBody();
  switch (choices_.Below(5)) {
    case 0:
      return body.setLinearFactor(Vector());
    case 1:
      return body.setAngularFactor(Vector());
    case 2:
      return body.setGravity(Vector());
    case 3:
      return body.setFlags(choices_.Below(16));
    default:
      body.setCcdMotionThreshold(btScalar(0.1));
      body.setCcdSweptSphereRadius(btScalar(0.2));
  }
}

void WorldGame::ChangeWorld() {
  btContactSolverInfo& info = world_->getSolverInfo();
  btScalar* const numbers[] = {&info.m_tau,
                               &info.m_damping,
                               &info.m_restitution,
                               &info.m_maxErrorReduction,
                               &info.m_sor,
                               &info.m_erp,
                               &info.m_erp2,
                               &info.m_globalCfm,
                               &info.m_frictionERP,
                               &info.m_frictionCFM,
                               &info.m_splitImpulsePenetrationThreshold,
                               &info.m_splitImpulseTurnErp,
                               &info.m_linearSlop,
                               &info.m_warmstartingFactor,
                               &info.m_maxGyroscopicForce,
                               &info.m_singleAxisRollingFrictionThreshold,
                               &info.m_leastSquaresResidualThreshold,
                               &info.m_restitutionVelocityThreshold};
  switch (choices_.Below(6)) {
    case 0:
      return world_->setGravity(Vector());
    case 1:
      info.m_numIterations = choices_.Below(40) - 1;
      return;
    case 2:
      info.m_solverMode = choices_.Byte() | choices_.Byte() << 8;
      return;
    case 3:
      info.m_splitImpulse = choices_.Below(2);
      info.m_minimumSolverBatchSize = choices_.OneIn(2) ? 1 : 128;
      return;
    default:
      *numbers[choices_.Below(static_cast<int>(std::size(numbers)))] = Real();
  }
}

void WorldGame::ChangeSettings() {
  Settings settings;
  constexpr Method kMethods[] = {Method::kPgsSm, Method::kPgsSm, Method::kPgs, Method::kPsor};
  settings.method = kMethods[choices_.Below(4)];
  settings.path = choices_.OneIn(4) ? kPaths[choices_.Below(5)] : Path::kAuto;
  settings.k_gs = 1 + choices_.Below(6);
  settings.k_sm = choices_.Below(4);
  settings.tuning.min_sweeps = choices_.Below(3);
  settings.max_sweeps = choices_.Below(60);
  settings.step_policy = StepPolicy(choices_.Below(2));
  settings.tuning.lifted_friction = detail::LiftedFriction(choices_.Below(2));
  settings.acceleration = Acceleration(choices_.Below(2));
  if (choices_.OneIn(3)) settings.budget = Budget::Work(choices_.Byte() * choices_.Byte());
  if (choices_.OneIn(4)) settings.tolerance = 0;
  if (choices_.OneIn(64)) settings.tuning.omega = numbers_.Real();  // of which most are refused
  settings.threads = play_.threads;
  solver_->settings() = settings;
}

void WorldGame::ChangeOptions() {
  bullet::Options& options = solver_->options();
  options.mode = choices_.OneIn(6) ? bullet::Mode::kReference : bullet::Mode::kFast;
  options.contacts =
      choices_.OneIn(4) ? bullet::ContactForm::kRows : bullet::ContactForm::kManifolds;
  options.warm_start_friction = !choices_.OneIn(4);
  options.warm_start_joints = !choices_.OneIn(4);
  options.geometric_stiffness = !choices_.OneIn(4);
  options.resting_slop = !choices_.OneIn(4);
  if (choices_.OneIn(8)) solver_->reset();
}

/// What only its user moves.
void WorldGame::MoveUnmoved() {
  for (const Piece& piece : pieces_) {
    if (!piece.body->isStaticOrKinematicObject()) continue;
    btTransform pose = piece.body->getWorldTransform();
    pose.setOrigin(pose.getOrigin() + Vector() / 10);
    piece.body->setWorldTransform(pose);
    if (choices_.OneIn(2)) world_->updateSingleAabb(piece.body.get());
    if (choices_.OneIn(4)) return;
  }
}

}  // namespace cairn::test
