// SPDX-License-Identifier: MIT
// Games made of bytes: frames of a changing world through one solver.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cairn/detail/eigen.h"
#include "cairn/solver.h"
#include "tests/fuzz/choices.h"
#include "tests/fuzz/play.h"

namespace cairn::test {

/// All that a frame reads and writes.
struct GameWorld {
  std::vector<Body> bodies;
  std::vector<Row> rows;
  std::vector<Manifold> manifolds;
  std::vector<ContactPoint> points;
  ContactLaw law;
  std::vector<ContactMotion> motions;
  std::vector<ContactTwist> twists;
  std::vector<Joint> joints;
  std::vector<JointRow> joint_rows;
  std::vector<double> row_impulses;
  std::vector<ContactImpulse> point_impulses;
  std::vector<TwistImpulse> twist_impulses;
  std::vector<float> joint_impulses;
  std::vector<Velocity> velocities;

  ContactProblem problem() const {
    return {bodies, rows, manifolds, points, law, motions, twists, joints, joint_rows};
  }
  Impulses impulses() { return {row_impulses, point_impulses, twist_impulses, joint_impulses}; }
};

/// Changes a world from frame to frame.
class GameMaker {
 public:
  explicit GameMaker(Choices* choices) : choices_(*choices), numbers_(choices) {}

  Settings MakeSettings();
  void NextFrame(GameWorld* world);
  /// Over which numbers are spread.
  int decades() const { return numbers_.decades(); }

 private:
  void ChangeBodies(GameWorld* world);
  void ChangeRows(GameWorld* world);
  void ChangeJoints(GameWorld* world);
  void ChangeManifolds(GameWorld* world);
  void ChangeNumbers(GameWorld* world);
  void Fit(GameWorld* world);
  Body MakeBody();
  Row MakeRow(const GameWorld& world);
  JointRow MakeJointRow();
  ContactPoint MakePoint();
  int AnyBody(const GameWorld& world);
  Eigen::Vector3d Vector() { return {numbers_.Real(), numbers_.Real(), numbers_.Real()}; }
  void Put(float* to);

  Choices& choices_;
  Numbers numbers_;
};

/// Plays the game of these bytes, on the instruction set that CAIRN_SIMD asks for.
GameResult PlayGame(std::span<const std::uint8_t> bytes, const Play& play);

/// The same by PlayEverywhere().
std::string PlayContactGame(std::span<const std::uint8_t> bytes);

/// Solves the problem in matrix form of these bytes by a method of theirs, likewise.
std::string SolveMatrix(std::span<const std::uint8_t> bytes);

}  // namespace cairn::test
