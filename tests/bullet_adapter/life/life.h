// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "scenes/random.h"
#include "tests/bullet_adapter/watched_solver.h"

namespace cairn::test {

/// What a Life has seen.
struct LifeFacts {
  int bodies_added = 0, bodies_removed = 0, joints_added = 0, joints_removed = 0;
  int joints_broken = 0;   ///< by their load
  int sleepers = 0;        ///< most bodies asleep at a time
  int foreign_frames = 0;  ///< with a joint of a type that Bullet does not ship
  int refusals = 0;        ///< frames that fell back without such a joint, or the other way round
  int not_finite = 0;      ///< frames with a velocity, position, impulse or feedback that is not
  double speed = 0;        ///< largest [m/s]
  double spin = 0;         ///< largest [rad/s]
  double energy = 0;       ///< largest kinetic energy per mass of the whole world [J/kg]
  double depth = 0;        ///< of the deepest body below the ground [m]
};

/// A pit in which bodies and joints of every kind come and go at random, some are moved by hand,
/// some break, some are left in peace until they sleep. The seed and nothing else decides.
class Life {
 public:
  Life(std::uint64_t seed, WatchedSolver* solver);
  ~Life();
  Life(const Life&) = delete;
  Life& operator=(const Life&) = delete;

  void Frame();

  const LifeFacts& facts() const { return facts_; }
  /// Of all poses, velocities and joint impulses of all frames.
  std::uint64_t hash() const { return hash_; }

 private:
  struct Piece {
    std::vector<std::unique_ptr<btCollisionShape>> shapes;  ///< the last one is the body's
    std::unique_ptr<btRigidBody> body;
    btVector3 drift{0, 0, 0};  ///< of a kinematic one [m/s]
    bool kinematic() const { return body->isKinematicObject(); }
  };
  struct Link {
    std::unique_ptr<btTypedConstraint> joint;
    std::unique_ptr<btJointFeedback> feedback;
    bool was_enabled = true;
  };

  int Below(int count) { return static_cast<int>(random_.Within(0, count)); }
  bool Chance(double probability) { return random_.Within(0, 1) < probability; }
  btScalar Between(double low, double high) {
    return static_cast<btScalar>(random_.Within(low, high));
  }
  Piece* AnyPiece() { return pieces_[Below(static_cast<int>(pieces_.size()))].get(); }

  void BuildPit();
  btCollisionShape* AddShape(Piece* piece);
  btRigidBody* AddBody(const btTransform& pose);
  void AddLink(std::unique_ptr<btTypedConstraint> joint);
  void AddLimb();
  void Tie();
  void AddForeign();
  void RemovePiece(int index);
  void RemoveLink(int index);
  void ChangeMass();
  void ToggleKinematic();
  void ChangeLink();
  void ChangeSolver();
  void Disturb();
  void MoveKinematic();
  void RemoveLost();

  void Observe();
  void ObserveBodies();
  void ObserveLinks();
  bool Finite(const btVector3& value);

  bench::Random random_;
  WatchedSolver* solver_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  std::vector<std::unique_ptr<btCollisionShape>> pit_shapes_;
  std::vector<std::unique_ptr<btRigidBody>> pit_;
  std::vector<std::unique_ptr<Piece>> pieces_;
  std::vector<Link> links_;
  int frame_ = 0;
  bool finite_ = true;
  std::uint64_t hash_ = 0xcbf29ce484222325u;
  LifeFacts facts_;
};

}  // namespace cairn::test
