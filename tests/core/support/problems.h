// SPDX-License-Identifier: MIT
// Problems that the tests of the core share, and ways to solve and compare them.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <vector>

#include "cairn/solver.h"

namespace cairn::test {

using Eigen::Vector3d;

/// What gravity adds to a velocity in a frame of 1/60 s [m/s].
inline constexpr double kGravityStep = 9.81 / 60;

/// Owns what a ContactProblem points to.
struct Scene {
  std::vector<Body> bodies;
  std::vector<Vector3d> positions;  ///< one per body where rows act on points, else empty
  std::vector<Row> rows;

  ContactProblem problem() const { return {bodies, rows}; }
};

struct Solution {
  Report report;
  std::vector<double> x;
  std::vector<Velocity> v;
};

/// From @p start, or from zero impulses if there is none.
Solution Solve(Solver* solver, const Scene& scene, std::vector<double> start = {});
/// By a new solver.
Solution Solve(const Settings& settings, const Scene& scene, std::vector<double> start = {});

/// Impulses and velocities, to the bit.
testing::AssertionResult SameBits(const Solution& a, const Solution& b);

/// Largest |a_i - b_i| of impulses, and of the six numbers of velocities.
double Distance(const std::vector<double>& a, const std::vector<double>& b);
double Distance(const std::vector<Velocity>& a, const std::vector<Velocity>& b);

/// So many sweeps in double precision, row by row in the order given, and nothing else: no steps,
/// no look at the residual. A budget may forbid them all, here and in AlwaysSteps().
Settings PlainSweeps(int sweeps);
/// A step after every k_gs such sweeps, whatever it costs, and no look at the tolerance.
Settings AlwaysSteps(int sweeps);

/// The same numbers with every standard library and compiler: call it once in an expression.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double Uniform(double lo, double hi);
  int Index(int size) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(size)); }
  Vector3d Vector(double size);  ///< each entry in (-size, size)
  Vector3d Direction();
  Eigen::Matrix3d Rotation();

 private:
  std::mt19937_64 engine_;
};

/// A body that cannot turn. @p impulse over the step [N s]
Body PointMass(double mass, const Vector3d& impulse = Vector3d::Zero());
/// A box with its axes along those of the world.
Body Box(double mass, const Vector3d& sides);
/// Any inertia in any direction, moving and pushed.
Body RandomBody(Random* random);

/// Impulse on a along @p direction, on b against it, at the centres: neither turns. Without bounds.
Row LinearRow(int a, int b, const Vector3d& direction);
/// The same, and only pushes.
Row PushRow(int a, int b, const Vector3d& normal);
/// Torque on a about @p axis, on b against it.
Row AngularRow(int a, int b, const Vector3d& axis);
/// Impulse at a point of the world. @pre the scene has positions
Row PointRow(const Scene& scene, int a, int b, const Vector3d& point, const Vector3d& direction);

/// A normal row and two friction rows, the normal from b to a.
void AddContact(Scene* scene, Row normal, const Vector3d& point, double friction);
/// Three joint rows.
void AddPin(Scene* scene, int a, int b, const Vector3d& point);

/// Boxes of 1 m and 1 kg on each other and the ground, four contact points in each face.
Scene Tower(int boxes);
/// Links of 1 kg and 1 m, hanging straight from the world, the last one of @p end_mass [kg].
Scene HangingChain(int links, double end_mass);

struct PileOptions {
  int bodies = 10;
  int contacts = 20;
  int pins = 0;
  double world_share = 0.2;  ///< of the contacts and pins
};
/// Bodies and contacts in all directions, with friction: nothing a game would build, and hard.
Scene RandomPile(const PileOptions& options, std::uint64_t seed);

}  // namespace cairn::test
