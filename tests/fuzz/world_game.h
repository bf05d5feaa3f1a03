// SPDX-License-Identifier: MIT
// Worlds of Bullet made of bytes, with the solver of the adapter.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cairn/bullet/constraint_solver.h"
#include "tests/fuzz/choices.h"
#include "tests/fuzz/play.h"

namespace cairn::test {

/// Looks at what Cairn promises of each substep.
class JudgedSolver final : public bullet::ConstraintSolver {
 public:
  void prepareSolve(int bodies, int manifolds) override;
  btScalar solveGroup(btCollisionObject** bodies, int num_bodies, btPersistentManifold** manifolds,
                      int num_manifolds, btTypedConstraint** constraints, int num_constraints,
                      const btContactSolverInfo& info, btIDebugDraw* debug_drawer,
                      btDispatcher* dispatcher) override;
  void allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_drawer) override;

  std::string broken;           ///< the first promise that was
  bool must_solve = false;      ///< from now on: no number is bad, and none is extreme
  int solved = 0, refused = 0;  ///< substeps by Cairn, and left to Bullet

 private:
  void Judge(std::span<btCollisionObject* const> bodies, std::span<btTypedConstraint* const> joints,
             bool was_finite);
  void JudgeSolved(std::span<btCollisionObject* const> bodies,
                   std::span<btTypedConstraint* const> joints, bool was_finite);
  void Break(const std::string& promise);

  bool collecting_ = false;
};

/// A world in which anything may happen at any time that Bullet calls its user.
class WorldGame final : private btActionInterface {
 public:
  explicit WorldGame(Choices* choices, const Play& play);
  ~WorldGame() override;

  /// Steps, with what happens before, in callbacks and after.
  void Frame();
  /// Removes all bodies and joints and gives the solver a world that nobody can refuse.
  void EndWithAPlainWorld();

  /// Whether there are bodies enough to be worth threads.
  bool has_pile() const { return has_pile_; }
  const JudgedSolver& solver() const { return *solver_; }
  /// Of all that was seen so far; numbers that are none are all alike.
  std::uint64_t hash() const { return hash_.value(); }

 private:
  /// When something happens.
  enum class Moment { kBefore, kTick, kAction, kTickEnd, kCount };

  struct Piece {
    std::vector<std::unique_ptr<btCollisionShape>> shapes;  ///< the last one is the body's
    std::unique_ptr<btRigidBody> body;
  };
  struct Link {
    std::unique_ptr<btTypedConstraint> joint;
    std::unique_ptr<btJointFeedback> feedback;
  };

  void updateAction(btCollisionWorld*, btScalar) override { Happen(Moment::kAction); }
  void debugDraw(btIDebugDraw*) override {}

  bool empty() const { return pieces_.empty(); }
  btRigidBody& AnyBody() { return *pieces_[choices_.Below(static_cast<int>(pieces_.size()))].body; }
  btScalar Real() { return static_cast<btScalar>(numbers_.Real()); }
  btScalar Positive() { return static_cast<btScalar>(numbers_.Positive()); }
  btVector3 Vector() {
    const btScalar x = Real(), y = Real();
    return {x, y, Real()};
  }
  /// 0, 1, and far from it.
  btScalar Mass();
  btVector3 Inertia(const btCollisionShape& shape, btScalar mass);
  btTransform Pose();

  void Happen(Moment moment);
  void HappenOnce();
  void AddGround();
  void AddPile();
  void AddBody();
  btRigidBody* PlaceBox(const btVector3& half, btScalar mass, const btTransform& pose);
  btRigidBody* Place(Piece piece, btScalar mass, const btVector3& inertia, const btTransform& pose);
  void RemoveBody(int index);
  void RemoveBad();
  void AddJoint();
  void RemoveJoint(int index);
  void ChangeJoint();
  void ChangeMotion();
  void ChangeMass();
  void ChangeKind();
  void ChangeSurface();
  void ChangeSleep();
  void ChangeFactors();
  void ChangeWorld();
  void ChangeSettings();
  void ChangeOptions();
  void MoveUnmoved();
  void Fold();
  void FoldNumber(btScalar number);
  void FoldVector(const btVector3& vector);

  Choices& choices_;
  Numbers numbers_;
  Play play_;
  std::unique_ptr<JudgedSolver> solver_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  std::vector<Piece> pieces_;
  std::vector<Link> links_;
  int events_[static_cast<int>(Moment::kCount)] = {};  ///< still to happen in this frame
  bool has_pile_ = false;
  Hash hash_;
};

/// Plays the world of these bytes, on the instruction set that CAIRN_SIMD asks for.
GameResult PlayWorldOnce(std::span<const std::uint8_t> bytes, const Play& play);

/// The same by PlayEverywhere().
std::string PlayWorld(std::span<const std::uint8_t> bytes);

}  // namespace cairn::test
