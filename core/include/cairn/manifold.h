// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <cstdint>

#include "cairn/detail/host.h"

namespace cairn {

/// Where two bodies touch. In floats, a cache line: kernels make rows of it, 16 manifolds at a
/// time, and no Row is ever written.
///
/// The rows of a point, with vectors for body_a (opposite ones for body_b):
///   normal:   lo = 0, hi = infinity, target = bias + bounce,
///   friction: along t1, and along t2 = t1 x normal where the manifold asks for two directions;
///             bounds +-friction x_normal, target 0. Where t1 is where the point slides to, those
///             of t2 are friction min(1, friction v / slide) x_normal: what slides faster than
///             friction stops in a step is hardly held across its way, and does not veer.
/// v: the larger of the speed at which the bodies close and of what external impulses add to that
/// of one of them. bounce = -restitution vn where the bodies approach faster than
/// ContactLaw::bounce_speed (vn: the velocity along the normal before external impulses), else 0.
struct ContactPoint {
  float arm_a[3] = {};   ///< From the centre of mass of body_a to the point [m], world axes.
  float arm_b[3] = {};   ///< Likewise.
  float normal[3] = {};  ///< Unit vector, from body_b to body_a.
  /// t1, a unit vector across the normal; zeros: where the point slides to, or any direction if it
  /// does not slide.
  float tangent[3] = {};
  float bias = 0;         ///< Velocity asked for along the normal: penetration, gaps [m/s].
  float restitution = 0;  ///< >= 0
  float friction = 0;     ///< Coefficient, >= 0.
  float compliance = 0;   ///< E of the normal row [1/kg], >= 0; read if Manifold::soft.
};

/// What a point of contact exerts on body_a (and its opposite on body_b). As a start: that of an
/// earlier frame, or zeros.
struct ContactImpulse {
  float normal = 0;              ///< [N s]
  float tangential[2] = {0, 0};  ///< Along t1 and t2 [N s].
  float heading = 0;  ///< Of t1, for the next frame; see detail/host.h. 0 where there was none.
  float direction[3] = {0, 0, 0};  ///< t1; of a start, it is not looked at.
};

/// What resists turning at a point of contact, where Manifold::twists says so: rows about the
/// normal, and about the two axes across it, with vectors for body_a (opposite ones for body_b);
/// bounds +-min(coefficient x_normal, most), target 0.
struct ContactTwist {
  float spinning = 0;       ///< Coefficient about the normal [m], >= 0.
  float rolling = 0;        ///< About the axes across it [m], >= 0.
  float most_spinning = 0;  ///< However hard the bodies are pressed together [N m s], >= 0.
  float most_rolling = 0;   ///< Likewise.
};

/// What resistance to turning exerts on body_a [N m s]. As a start: that of an earlier frame, or
/// zeros.
struct TwistImpulse {
  float spinning = 0;
  float rolling[2] = {0, 0};
};

/// Points of contact between two bodies, at most one of which is kWorld.
struct Manifold {
  static constexpr int kMostPoints = 4;

  int body_a = kWorld, body_b = kWorld;
  int first_point = 0;       ///< In ContactProblem::points.
  std::int8_t points = 1;    ///< In [1, kMostPoints].
  std::int8_t tangents = 2;  ///< Directions of friction, in [0, 2].
  bool soft = false;         ///< Points have a compliance.
  bool twists = false;       ///< Points resist turning, see ContactTwist.
  std::uint8_t speeds = 0;   ///< Bit i: bias of point i is a speed, not depth; Settings::relax.
  detail::RowHost host = {};

  int rows() const { return points * (1 + tangents + (twists ? kTwistRows : 0)); }

  static constexpr int kTwistRows = 3;  ///< Of a point.
};

/// What all points of contact of a problem have in common.
struct ContactLaw {
  /// Bodies that approach slower than this do not bounce [m/s], >= 0.
  float bounce_speed = 0;
  detail::ContactHost host = {};
};

}  // namespace cairn
