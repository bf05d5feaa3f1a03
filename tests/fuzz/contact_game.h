// SPDX-License-Identifier: MIT
// Games made of bytes: frames of a changing world through one solver.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cairn/solver.h"
#include "tests/fuzz/choices.h"

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

/// How a game is played: none of this may change a bit.
struct Play {
  std::string simd;  ///< CAIRN_SIMD
  int threads = 1;
};

struct GameResult {
  std::uint64_t hash = 0;
  std::string broken;  ///< the promise that was; empty if none was
};

/// Plays the game of these bytes.
GameResult PlayGame(std::span<const std::uint8_t> bytes, const Play& play);

/// The same on every instruction set of this machine, on 1, 2 and 3 threads in turn. Returns the
/// promise that was broken, or nothing.
std::string PlayEverywhere(std::span<const std::uint8_t> bytes);

/// Solves the problem in matrix form of these bytes by a method of theirs, likewise.
std::string SolveMatrix(std::span<const std::uint8_t> bytes);

}  // namespace cairn::test
