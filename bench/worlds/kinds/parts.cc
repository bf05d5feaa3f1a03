// SPDX-License-Identifier: MIT
#include "worlds/kinds/parts.h"

#include <cmath>

namespace cairn::bench {
namespace {

template <class SixDof>
std::unique_ptr<SixDof> MakeSixDof(btRigidBody* a, btRigidBody* b, const btTransform& frame);

template <>
std::unique_ptr<btGeneric6DofConstraint> MakeSixDof(btRigidBody* a, btRigidBody* b,
                                                    const btTransform& frame) {
  return std::make_unique<btGeneric6DofConstraint>(*a, *b, Local(*a, frame), Local(*b, frame),
                                                   true);
}

template <>
std::unique_ptr<btGeneric6DofSpring2Constraint> MakeSixDof(btRigidBody* a, btRigidBody* b,
                                                           const btTransform& frame) {
  return std::make_unique<btGeneric6DofSpring2Constraint>(*a, *b, Local(*a, frame),
                                                          Local(*b, frame));
}

/// Holds a point and lets the bodies turn by up to 0.6 rad.
template <class SixDof>
void HoldLoosely(Draft* draft, btRigidBody* a, btRigidBody* b, const btTransform& frame) {
  constexpr btScalar kTurn = btScalar(0.6);
  SixDof* const joint = draft->Add(MakeSixDof<SixDof>(a, b, frame));
  joint->setLinearLowerLimit(btVector3(0, 0, 0));
  joint->setLinearUpperLimit(btVector3(0, 0, 0));
  joint->setAngularLowerLimit(btVector3(-kTurn, -kTurn, -kTurn));
  joint->setAngularUpperLimit(btVector3(kTurn, kTurn, kTurn));
}

}  // namespace

Hold DrawHold(Draft* draft) {
  constexpr Hold kHolds[] = {Hold::kPin,   Hold::kPin,  Hold::kPin,    Hold::kTwoPins,
                             Hold::kHinge, Hold::kCone, Hold::kSixDof, Hold::kSpring2};
  return kHolds[draft->Choose(8)];
}

btPoint2PointConstraint* Pin(Draft* draft, btRigidBody* a, btRigidBody* b, const btVector3& point) {
  return draft->Add(std::make_unique<btPoint2PointConstraint>(
      *a, *b, a->getCenterOfMassTransform().inverse() * point,
      b->getCenterOfMassTransform().inverse() * point));
}

btHingeConstraint* Hinge(Draft* draft, btRigidBody* a, btRigidBody* b, const btTransform& frame) {
  return draft->Add(
      std::make_unique<btHingeConstraint>(*a, *b, Local(*a, frame), Local(*b, frame)));
}

btConeTwistConstraint* Cone(Draft* draft, btRigidBody* a, btRigidBody* b,
                            const btTransform& frame) {
  return draft->Add(
      std::make_unique<btConeTwistConstraint>(*a, *b, Local(*a, frame), Local(*b, frame)));
}

btFixedConstraint* Fix(Draft* draft, btRigidBody* a, btRigidBody* b, const btVector3& point) {
  const btTransform frame(btQuaternion::getIdentity(), point);
  return draft->Add(
      std::make_unique<btFixedConstraint>(*a, *b, Local(*a, frame), Local(*b, frame)));
}

void Connect(Draft* draft, Hold hold, btRigidBody* a, btRigidBody* b, const Joining& at) {
  switch (hold) {
    case Hold::kPin:
      Pin(draft, a, b, at.point);
      break;
    case Hold::kTwoPins:
      Pin(draft, a, b, at.point - at.half_width * at.axis);
      Pin(draft, a, b, at.point + at.half_width * at.axis);
      break;
    case Hold::kHinge:
      Hinge(draft, a, b, FrameAlongZ(at.point, at.axis));
      break;
    case Hold::kCone:
      Cone(draft, a, b, FrameAlongX(at.point, at.along))
          ->setLimit(btScalar(0.8), btScalar(0.8), btScalar(0.5));
      break;
    case Hold::kSixDof:
      HoldLoosely<btGeneric6DofConstraint>(draft, a, b, FrameAlongX(at.point, at.along));
      break;
    case Hold::kSpring2:
      HoldLoosely<btGeneric6DofSpring2Constraint>(draft, a, b, FrameAlongX(at.point, at.along));
      break;
    case Hold::kFixed:
      Fix(draft, a, b, at.point);
      break;
  }
}

std::vector<btRigidBody*> AddStrand(Draft* draft, const Strand& strand,
                                    std::span<const btVector3> line) {
  std::vector<btRigidBody*> links;
  const int count = static_cast<int>(line.size()) - 1;
  for (int i = 0; i < count; ++i) {
    const btVector3 along = line[i + 1] - line[i], middle = (line[i] + line[i + 1]) / 2;
    const btScalar half = along.length() / 2;
    const bool held = (i == 0 && strand.first_static) || (i == count - 1 && strand.last_static);
    const btScalar mass = held ? 0 : strand.mass;
    const btTransform pose = FrameAlongX(middle, along);
    // Capsules lie along y.
    const btTransform upright(btQuaternion(btVector3(0, 0, 1), -SIMD_HALF_PI));
    links.push_back(
        strand.round
            ? draft->Capsule(strand.half_thickness, std::max(half, strand.half_thickness), mass,
                             pose * upright)
            : draft->Box(btVector3(half * btScalar(0.95), strand.half_thickness, strand.half_width),
                         mass, pose));
    if (i > 0) {
      Connect(draft, strand.hold, links[i - 1], links[i],
              {line[i], btVector3(0, 0, 1), along, strand.half_width * btScalar(0.9)});
    }
  }
  return links;
}

std::vector<btVector3> Straight(const btVector3& from, const btVector3& step, int links) {
  std::vector<btVector3> line;
  for (int i = 0; i <= links; ++i) line.push_back(from + btScalar(i) * step);
  return line;
}

std::vector<btVector3> Sagging(const btVector3& from, const btVector3& to, btScalar sag,
                               int links) {
  std::vector<btVector3> line;
  for (int i = 0; i <= links; ++i) {
    const btScalar share = btScalar(i) / btScalar(links), u = 2 * share - 1;
    line.push_back(from + share * (to - from) - btVector3(0, sag * (1 - u * u), 0));
  }
  return line;
}

}  // namespace cairn::bench
