// SPDX-License-Identifier: MIT
#pragma once

#include <btBulletDynamicsCommon.h>

#include <array>
#include <string>
#include <unordered_map>
#include <vector>

#include "scenes/world.h"

namespace cairn::cli {

/// Where a body is: position [m] and a unit quaternion x, y, z, w.
struct Pose {
  std::array<float, 3> position{};
  std::array<float, 4> rotation{0, 0, 0, 1};
};

/// A shape as it is drawn.
struct AnimatedShape {
  /// "box" (half extents), "sphere" (radius), "cylinder" (radius, height), "capsule" (radius,
  /// distance of the centres), all along y; "hull" and "triangles" (corners, three numbers each).
  std::string kind;
  std::vector<float> numbers;  ///< [m]
};

/// A piece of a body.
struct AnimatedPart {
  int shape = 0;
  Pose pose;  ///< In the frame of the body.
};

struct AnimatedBody {
  std::vector<AnimatedPart> parts;
};

struct AnimationFrame {
  std::vector<Pose> poses;  ///< Of the dynamic bodies, which may grow in number.
  /// Of each: the deepest overlap of its contacts or the largest gap of its joints [m].
  std::vector<float> errors;
};

/// The motion of a world.
struct Animation {
  std::array<float, 3> up{0, 1, 0};  ///< Against gravity.
  std::vector<AnimatedShape> shapes;
  std::vector<AnimatedBody> bodies;        ///< Dynamic ones.
  std::vector<AnimatedBody> still_bodies;  ///< Static ones, in their place.
  std::vector<Pose> still_poses;
  std::vector<AnimationFrame> frames;  ///< The first is the world as built.
};

/// Takes down how a world moves.
class AnimationRecorder {
 public:
  /// The world as it is now, as the next frame.
  void Take(const bench::World& world);
  Animation Finish() { return std::move(animation_); }

 private:
  void AddNewBodies(const bench::World& world);
  AnimatedBody Describe(const btCollisionShape& shape);
  void AddParts(const btCollisionShape& shape, const btTransform& pose, AnimatedBody* body);
  int ShapeOf(const btCollisionShape& shape);
  std::vector<float> Errors(const bench::World& world) const;

  Animation animation_;
  std::unordered_map<const btCollisionShape*, int> shapes_;
  std::unordered_map<const btCollisionObject*, int> index_;  ///< of dynamic bodies
};

}  // namespace cairn::cli
