// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "scenes/world.h"

namespace cairn::bench {

/// How deep the deepest contact point is [m], 0 if nothing overlaps. As of the last step's
/// collision detection, in Bullet's measure: a convex shape includes its collision margin.
double MaxPenetration(const World& world);
/// Impulses of friction times how far their two points are apart, summed [N m s], after a step: it
/// turns the whole by that at most.
double FrictionTwist(const World& world);

/// Points of contact of the last step's collision detection, those that still are apart included.
int ContactPoints(const World& world);

/// Distance between the two anchor points of a joint now [m]: what a perfect solver keeps at 0. NaN
/// for joints whose anchors may part by design: sliders, gears, and 6-dof joints with a linear axis
/// that is not locked at 0.
double JointGap(const btTypedConstraint& joint);

/// The largest JointGap() [m]; NaN if there is no joint that has one.
double LargestJointGap(const World& world);

/// The sum of all JointGap() [m]; NaN if there is no joint that has one.
double TotalJointGap(const World& world);

/// The largest speed of a centre of mass [m/s], 0 without dynamic bodies.
double LargestSpeed(const World& world);

/// The height of the highest centre of mass of a dynamic body [m]; -infinity without dynamic
/// bodies.
double TopHeight(const World& world);

/// Mass of the dynamic bodies [kg].
double TotalMass(const World& world);

/// Kinetic energy plus potential energy against the origin of the dynamic bodies [J].
double TotalEnergy(const World& world);

/// What is true of the bodies that hang together with one of them, as of the last step.
struct IslandFacts {
  int bodies = 0, joints = 0, contacts = 0;
  double mass = 0;                                   ///< Of all [kg].
  double speed = 0, penetration = 0, joint_gap = 0;  ///< The largest [m/s], [m], [m].
  bool asleep = false;
};

/// @param body  its place in World::dynamic_bodies()
IslandFacts FactsOfIsland(const World& world, int body);

/// FNV-1a of the bytes of all poses and velocities of dynamic bodies: equal for equal bits.
std::uint64_t StateHash(const World& world);

}  // namespace cairn::bench
