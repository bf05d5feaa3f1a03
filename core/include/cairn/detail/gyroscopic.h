// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

namespace cairn {

/// Bodies whose gyroscopic terms are wanted, up to kMost at a time: number k of body l is at
/// [k][l]. Lanes of no body may hold anything.
template <class Scalar>
struct Gyroscopes {
  static constexpr int kMost = 16;

  /// What is turned by a torque along each principal axis, >= 0 [1/(kg m^2)]; 0: cannot turn.
  alignas(64) Scalar inv_moment[3][kMost] = {};
  /// x y z w of the unit quaternion that turns the principal axes into the world.
  alignas(64) Scalar turn[4][kMost] = {};
  alignas(64) Scalar spin[3][kMost] = {};  ///< In the world [rad/s].
  /// What gyroscopic terms add to the spin over a step; written by FindGyroscopicTerms() [rad/s].
  alignas(64) Scalar change[3][kMost] = {};
};

/// Finds what gyroscopic terms add to the spins of bodies over a step [s], > 0: the implicit Euler
/// step of I dw/dt = -w x I w in the frame of the body, by one step of Newton's method, which does
/// not gain energy where the explicit one does. The same bits on every target. Numbers are not
/// checked: what is not finite makes its own lane so.
///
/// Source: E. Catto, Physics for Game Programmers: Numerical Methods, GDC 2015, and Bullet's
/// btRigidBody::computeGyroscopicImpulseImplicit_Body(), of which these are the operations in their
/// order, to the last bit, without those on zeros. As there, a Jacobian whose determinant is below
/// the epsilon of the type is not inverted, which leaves spins of very light bodies almost as they
/// are.
/// @param bodies  all lanes are done
void FindGyroscopicTerms(float time_step, Gyroscopes<float>* bodies);
void FindGyroscopicTerms(double time_step, Gyroscopes<double>* bodies);

}  // namespace cairn
