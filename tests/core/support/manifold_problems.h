// SPDX-License-Identifier: MIT
// Contacts as manifolds, and joints.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "problems.h"

namespace cairn::test {

/// Owns what a ContactProblem with manifolds and joints points to, and the impulses of its points.
struct ManifoldScene {
  std::vector<Body> bodies;
  std::vector<Row> rows;
  std::vector<Manifold> manifolds;
  std::vector<ContactPoint> points;
  ContactLaw law;
  std::vector<ContactMotion> motions;
  std::vector<double> row_impulses;
  std::vector<ContactTwist> twists;  ///< one per point, or none
  std::vector<ContactImpulse> point_impulses;
  std::vector<TwistImpulse> twist_impulses;
  std::vector<Joint> joints;
  std::vector<JointRow> joint_rows;
  std::vector<float> joint_impulses;
  std::vector<float> joint_errors;  ///< one per row, or none

  ContactProblem problem() const {
    return {bodies,  rows,   manifolds, points,     law,
            motions, twists, joints,    joint_rows, joint_errors};
  }
  Impulses impulses() { return {row_impulses, point_impulses, twist_impulses, joint_impulses}; }
};

/// Bodies of all kinds, some of them unmoved but moving, and manifolds of one to four points in all
/// directions, each with friction, bounce, compliance and start impulses of its own.
ManifoldScene RandomManifolds(int bodies, int manifolds, std::uint64_t seed);
/// The same, of which half resist turning.
ManifoldScene RollingManifolds(int bodies, int manifolds, std::uint64_t seed);
/// Adds joints of one to eight rows, bounded and soft ones among them, with and without opposite
/// forces, each with start impulses of its own.
void AddJoints(int joints, std::uint64_t seed, ManifoldScene* scene);
/// Boxes of 1 m and 1 kg on each other and the ground, four contact points in each face.
ManifoldScene ManifoldTower(int boxes);

/// What of a solution there is to compare, to the bit.
bool SameTwist(const TwistImpulse& a, const TwistImpulse& b);
testing::AssertionResult SameBits(std::span<const ContactImpulse> a,
                                  std::span<const ContactImpulse> b);

}  // namespace cairn::test
