// SPDX-License-Identifier: MIT
#include "tests/fuzz/world_game.h"

#include <chrono>
#include <cmath>
#include <limits>

namespace cairn::test {
namespace {

constexpr int kMostFrames = 16;
constexpr int kFramesOfAPile = 2;
constexpr int kMostEvents = 2;  // at each moment of a frame
constexpr int kPlainFrames = 3;
/// Of one world on one instruction set; most take a hundredth of a second.
constexpr std::chrono::seconds kMostTime{10};

}  // namespace

WorldGame::WorldGame(Choices* choices, const Play& play)
    : choices_(*choices), numbers_(choices), play_(play) {
  solver_ = std::make_unique<JudgedSolver>();
  world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, solver_.get(),
                                                     &configuration_);
  world_->setGravity({0, btScalar(-9.81), 0});
  const auto tick = [](btDynamicsWorld* world, btScalar) {
    static_cast<WorldGame*>(world->getWorldUserInfo())->Happen(Moment::kTick);
  };
  const auto tick_end = [](btDynamicsWorld* world, btScalar) {
    static_cast<WorldGame*>(world->getWorldUserInfo())->Happen(Moment::kTickEnd);
  };
  world_->setInternalTickCallback(tick, this, true);
  world_->setInternalTickCallback(tick_end, this, false);
  world_->addAction(this);
  ChangeSettings();
  ChangeOptions();
  AddGround();
  has_pile_ = choices_.OneIn(64);
  if (has_pile_) AddPile();
  for (int i = choices_.Below(10); i >= 0; --i) AddBody();
  for (int i = choices_.Below(6); i > 0; --i) AddJoint();
}

WorldGame::~WorldGame() {
  while (!links_.empty()) RemoveJoint(0);
  while (!pieces_.empty()) RemoveBody(static_cast<int>(pieces_.size()) - 1);
  world_->removeAction(this);
}

void WorldGame::Happen(Moment moment) {
  for (int& left = events_[static_cast<int>(moment)]; left > 0; --left) HappenOnce();
}

void WorldGame::HappenOnce() {
  const int kind = choices_.Below(20);
  if (empty() || kind < 3) return AddBody();
  switch (kind) {
    case 3:
    case 4:
      return RemoveBody(choices_.Below(static_cast<int>(pieces_.size())));
    case 5:
    case 6:
      return AddJoint();
    case 7:
      if (!links_.empty()) RemoveJoint(choices_.Below(static_cast<int>(links_.size())));
      return;
    case 8:
      return ChangeJoint();
    case 9:
    case 10:
      return ChangeMotion();
    case 11:
      return ChangeMass();
    case 12:
      return ChangeKind();
    case 13:
      return ChangeSurface();
    case 14:
      return ChangeSleep();
    case 15:
      return ChangeFactors();
    case 16:
      return ChangeWorld();
    case 17:
      return ChangeSettings();
    case 18:
      return ChangeOptions();
    default:
      return MoveUnmoved();
  }
}

void WorldGame::Frame() {
  for (int& events : events_) events = choices_.Below(kMostEvents + 1);
  const int refused = solver_->refused;
  Happen(Moment::kBefore);
  const btScalar frame = btScalar(1) / 60;
  switch (choices_.Below(10)) {
    case 0:
      world_->stepSimulation(0, 0);
      break;
    case 1:  // a substep of next to nothing
      world_->stepSimulation(btScalar(1e-9), 1, btScalar(1e-9));
      break;
    case 2:
      world_->stepSimulation(10, 0);
      break;
    case 3:
      world_->stepSimulation(frame, 4, frame / 4);
      break;
    case 4:
      world_->stepSimulation(btScalar(1e-4), 0);
      break;
    default:
      world_->stepSimulation(frame, 0);
  }
  if (solver_->refused > refused && choices_.OneIn(2)) RemoveBad();
  Fold();
}

void WorldGame::EndWithAPlainWorld() {
  for (int& events : events_) events = 0;
  while (!links_.empty()) RemoveJoint(0);
  while (!pieces_.empty()) RemoveBody(static_cast<int>(pieces_.size()) - 1);
  world_->getSolverInfo() = btContactSolverInfo();
  world_->setGravity({0, btScalar(-9.81), 0});
  solver_->settings().tuning.omega = 1;
  solver_->must_solve = true;
  AddGround();
  const btVector3 half(btScalar(0.5), btScalar(0.5), btScalar(0.5));
  const btVector3 inertia(btScalar(1) / 6, btScalar(1) / 6, btScalar(1) / 6);
  btTransform pose = btTransform::getIdentity();
  for (int i = 0; i < 2; ++i) {
    Piece piece;
    piece.shapes.push_back(std::make_unique<btBoxShape>(half));
    pose.setOrigin({0, btScalar(0.49) + btScalar(0.99) * btScalar(i), 0});
    Place(std::move(piece), 1, inertia, pose);
  }
  for (int i = 0; i < kPlainFrames; ++i) {
    world_->stepSimulation(btScalar(1) / 60, 0);
    Fold();
  }
}

void WorldGame::FoldNumber(btScalar number) {
  hash_.Add(std::isnan(number) ? std::numeric_limits<btScalar>::quiet_NaN() : number);
}

void WorldGame::FoldVector(const btVector3& vector) {
  for (int k = 0; k < 3; ++k) FoldNumber(vector[k]);
}

void WorldGame::Fold() {
  for (const Piece& piece : pieces_) {
    const btTransform& pose = piece.body->getWorldTransform();
    for (int k = 0; k < 3; ++k) FoldVector(pose.getBasis()[k]);
    FoldVector(pose.getOrigin());
    FoldVector(piece.body->getLinearVelocity());
    FoldVector(piece.body->getAngularVelocity());
    hash_.Add(piece.body->getActivationState());
  }
  for (const Link& link : links_) {
    FoldNumber(link.joint->internalGetAppliedImpulse());
    hash_.Add(link.joint->isEnabled());
    if (link.feedback == nullptr) continue;
    FoldVector(link.feedback->m_appliedForceBodyA);
    FoldVector(link.feedback->m_appliedTorqueBodyB);
  }
  const Report& report = solver_->report();
  hash_.Add(report.status);
  hash_.Add(report.sweeps);
  hash_.Add(report.work);
  hash_.Add(solver_->fell_back());
}

GameResult PlayWorldOnce(std::span<const std::uint8_t> bytes, const Play& play) {
  const auto start = std::chrono::steady_clock::now();
  Choices choices(bytes);
  WorldGame game(&choices, play);
  const int frames = game.has_pile() ? kFramesOfAPile : kMostFrames;
  for (int frame = 0; frame < frames && !(frame > 0 && choices.empty()); ++frame) {
    game.Frame();
  }
  game.EndWithAPlainWorld();
  GameResult result{game.hash(), game.solver().broken};
  const bool slow = std::chrono::steady_clock::now() - start > kMostTime;
  if (slow && result.broken.empty()) result.broken = "took longer than 10 s";
  return result;
}

std::string PlayWorld(std::span<const std::uint8_t> bytes) {
  return PlayEverywhere(&PlayWorldOnce, bytes);
}

}  // namespace cairn::test
