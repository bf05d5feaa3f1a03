// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "scenes/joints/joint_frames.h"
#include "worlds/draft.h"

namespace cairn::bench {

/// How two bodies hold together at a point.
enum class Hold { kPin, kTwoPins, kHinge, kCone, kSixDof, kSpring2, kFixed };

/// Any of them, those of ropes and chains more often.
Hold DrawHold(Draft* draft);

/// A ball joint.
btPoint2PointConstraint* Pin(Draft* draft, btRigidBody* a, btRigidBody* b, const btVector3& point);
/// Bullet's hinges turn about z of their frame.
btHingeConstraint* Hinge(Draft* draft, btRigidBody* a, btRigidBody* b, const btTransform& frame);
/// Bullet's cones open along x of their frame; the angles of swing and twist [rad].
btConeTwistConstraint* Cone(Draft* draft, btRigidBody* a, btRigidBody* b, const btTransform& frame);
btFixedConstraint* Fix(Draft* draft, btRigidBody* a, btRigidBody* b, const btVector3& point);

/// Where two bodies are connected: a point, the axis that hinges turn about, the way from one body
/// to the other, and how far two pins are from the point [m].
struct Joining {
  btVector3 point, axis, along;
  btScalar half_width;
};
void Connect(Draft* draft, Hold hold, btRigidBody* a, btRigidBody* b, const Joining& joining);

/// What a strand of links is made of: boxes or capsules between one point and the next.
struct Strand {
  Hold hold = Hold::kPin;
  btScalar half_thickness = btScalar(0.05), half_width = btScalar(0.05);  ///< [m]
  btScalar mass = 1;                                                      ///< Of a link [kg].
  bool round = false;                                                     ///< Capsules.
  bool first_static = false, last_static = false;
};

/// Links along a line in the xy plane, joined where the line bends. @pre at least two points
std::vector<btRigidBody*> AddStrand(Draft* draft, const Strand& strand,
                                    std::span<const btVector3> line);

/// Points from `from` on, `step` apart [m], along a direction; one more than links.
std::vector<btVector3> Straight(const btVector3& from, const btVector3& step, int links);
/// Points of a parabola between two ends that hangs `sag` [m] below the middle.
std::vector<btVector3> Sagging(const btVector3& from, const btVector3& to, btScalar sag, int links);

}  // namespace cairn::bench
