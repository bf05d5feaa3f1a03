// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cairn/joint.h"
#include "cairn/manifold.h"
#include "cairn/report.h"
#include "cairn/row.h"
#include "cairn/vector.h"

namespace cairn {

/// Linear [m/s] and angular [rad/s] velocity of a body, world axes.
struct Velocity {
  Vector3 linear = {}, angular = {};
};

/// A rigid body at the start of a time step. All vectors in world axes.
struct Body {
  double inv_mass = 0;  ///< [1/kg], >= 0; 0: no impulse changes its velocity (inv_inertia 0, too).
  /// Inverse inertia about the centre of mass [1/(kg m^2)], symmetric positive semidefinite.
  Matrix3 inv_inertia = {};
  /// Scales inv_mass along each world axis, >= 0; 0 locks it: rows along it leave the body alone.
  Vector3 linear_factor = {1, 1, 1};
  Velocity velocity = {};
  Vector3 impulse = {};          ///< External, over the step [N s].
  Vector3 angular_impulse = {};  ///< External [N m s].
  double strain = 0;  ///< h^2 k / I by GeometricStiffness, of joints that pull; 4 would blow up.
  /// Keeps its value while the body lives, 0 if there is no such name. What the solver learns about
  /// an island (does a step pay here?) is remembered under the smallest id in it.
  std::uint64_t id = 0;
};

/// One time step of bodies and constraints: find impulses x with
///   v = v_start + M^-1 (external impulses + J' x),
/// such that every row obeys its law (see Row). Without friction this is the boxed form of the
/// mixed LCP of the paper [1] with matrix J M^-1 J' + E; friction bounds follow other impulses.
///
/// The order of the rows matters on Path::kReference, and among the rows of two bodies.
/// Rows of joints follow @p rows, joint by joint; those of manifolds come last, manifold by
/// manifold, first the normals of its points, then the friction of each, then what resists turning.
/// Joints and manifolds are faster than the same as rows: nothing is written out.
///
/// [1] Morales, Nocedal, Smelyanskiy, "An algorithm for the fast solution of symmetric linear
///     complementarity problems", Numer. Math. 111 (2008) 251-266.
struct ContactProblem {
  std::span<const Body> bodies = {};
  std::span<const Row> rows = {};
  std::span<const Manifold> manifolds = {};
  std::span<const ContactPoint> points = {};  ///< Of the manifolds; others are not looked at.
  ContactLaw contact_law = {};
  /// One per body, or none. What joints and contacts see instead of the motion of the bodies, where
  /// these are at rest because velocities are counted from the start of the step.
  std::span<const ContactMotion> motions = {};
  std::span<const ContactTwist> twists = {};  ///< One per point, or none.
  std::span<const Joint> joints = {};
  std::span<const JointRow> joint_rows = {};  ///< Of the joints; others are not looked at.
  /// One per joint row, or none: what of its target takes back errors; if none: see Joint::errors.
  std::span<const float> joint_errors = {};
  double time_step = 0;  ///< [s], >= 0; 0: unknown. Tension, substeps and weighed steps go by it.
};

/// Rows of a problem, with those of joints and manifolds.
std::size_t AllRows(const ContactProblem& problem);

/// Impulses of a problem: where a Solve() starts, and what comes of it.
struct Impulses {
  std::span<double> rows = {};            ///< One per row [N s] or [N m s].
  std::span<ContactImpulse> points = {};  ///< One per point of contact.
  std::span<TwistImpulse> twists = {};    ///< One per ContactProblem::twists.
  std::span<float> joint_rows = {};       ///< One per ContactProblem::joint_rows [N s] or [N m s].
};

/// One number per row, in their order and along the directions of Measure(). @pre they belong to it
std::vector<double> AllImpulses(const ContactProblem& problem, const Impulses& impulses);

/// Measures impulses, one per row in the order of ContactProblem, in double precision and from the
/// problem alone. Fills the residuals of the report; bad input is answered as by Solver::Solve().
[[nodiscard]] Report Measure(const ContactProblem& problem, std::span<const double> impulses);

}  // namespace cairn
