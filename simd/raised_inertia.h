// SPDX-License-Identifier: MIT
#pragma once

#include "simd/pairs/pair_block.h"
#include "simd/principal_axes.h"
#include "simd/target.h"

namespace cairn::simd {

/// When and how inertia is raised; see GeometricStiffness.
struct RaiseRules {
  double time_step = 0;    ///< [s]
  double threshold = 0;    ///< strain up to which nothing is raised
  double hold = 0;         ///< share of what was needed that is still held a step later, in [0, 1]
  double same_moment = 0;  ///< share that two moments may differ by and have no axes of their own
  double on_line = 0;      ///< of arms across a line, by those along: below it they lie on it
};

/// Bodies whose joints pull: number k of lane l is at [k][l]. Symmetric matrices are xx yx zx yy zy
/// zz, in world axes; the rest is about principal axes, those of equal moments in the order of what
/// arms are across them. Lanes that nobody asks for may hold
/// anything.
struct RaisedInertia {
  alignas(64) double stiffness[6][kLanes] = {};  ///< K [N m], to be read.
  /// Sum of f^2 (r^2 1 - r r') over joints with a force f at the end of an arm r, to be read.
  alignas(64) double arms[6][kLanes] = {};
  /// What is held of the stiffness about each axis [N m], to be read and written.
  alignas(64) double held[3][kLanes] = {};
  alignas(64) double kept[3][kLanes] = {};  ///< moments over raised ones, to be read and written
  // the rest is to be written
  alignas(64) double held_ratio[kLanes] = {};      ///< the largest of held over moments [1 / s^2]
  alignas(64) double strain[kLanes] = {};          ///< h^2 times that
  alignas(64) double response[6][kLanes] = {};     ///< kept, as a matrix
  alignas(64) double carried[6][kLanes] = {};      ///< the least of 1 and kept now over kept before
  alignas(64) double inv_inertia[6][kLanes] = {};  ///< of the raised moments
};

/// The stiffness k about each axis is at least what K turns by (Gershgorin) and at least the share
/// of what was held. Axes of equal moments share the larger one, but for one that all arms lie
/// along: a ball on a string stays free to spin about it. kept = 1 / (1 + max(0, h^2 k / I -
/// threshold)). Moments and axes: those of the inverse inertia. Same bits on every target.
using RaiseKernel = void (*)(const RaiseRules& rules, const PrincipalAxes& axes,
                             RaisedInertia* lanes);

/// @pre the CPU supports it
RaiseKernel RaiseKernelFor(Target target);

}  // namespace cairn::simd
