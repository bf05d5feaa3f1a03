// SPDX-License-Identifier: MIT
#pragma once

#include "simd/pairs/pair_block.h"
#include "simd/rows/contact_body.h"
#include "simd/target.h"

namespace cairn::simd {

/// Numbers of a point of contact, in this order; see ContactPoint.
enum PointNumber {
  kArmA = 0,
  kArmB = 3,
  kNormal = 6,
  kTangent = 9,
  kBias = 12,
  kRestitution,
  kFriction,
  kCompliance,
  kPointNumbers
};
/// Numbers of a start impulse that are read: normal, two tangential ones, heading of the first; and
/// how many lie between one point and the next.
inline constexpr int kStartNumbers = 4, kStartStride = 7;
/// Numbers of what resists turning at a point: coefficients, and what it gives at most, of spinning
/// first; and its rows, each with one start impulse.
inline constexpr int kTwistNumbers = 4, kMostSpinning = 2, kTwistRows = 3;
/// Lines that are kept of a point with friction: direction and heading of t1.
inline constexpr int kDirectionLines = 4;

/// Points that a lane may have.
inline constexpr int kMostPoints = 4;

/// The manifolds of a block. Others than the first lanes are not looked at.
struct ContactLanes {
  PairForm form;
  int points, tangents;
  bool soft, twists;
  float bounce_speed;
  bool spin_before_torques, bounded_apart;
  int lanes;  ///< In use: the first ones, a multiple of four.
  const ContactBody* a[kLanes] = {};
  const ContactBody* b[kLanes] = {};
  /// The movable one of a PairForm::kSingle is b.
  bool second_moves[kLanes] = {};
  const float* point[kLanes] = {};  ///< kPointNumbers numbers a point, one after the other
  const float* start[kLanes] = {};  ///< a point every kStartStride numbers
  /// Likewise, kTwistNumbers and kTwistRows numbers a point, if there are twists.
  const float* twist[kLanes] = {};
  const float* twist_start[kLanes] = {};
};

/// Writes the lines of the pair and of its rows: the normals of all points, then the friction of
/// each, then what resists turning. @p x: start impulses, one line a row, inside their bounds. @p
/// directions: t1, three lines a point, if there is friction. False if a number is not finite or
/// does not fit a float with its square, or if a coefficient is negative. Same bits on every
/// target.
using ContactRowsKernel = bool (*)(const ContactLanes& lanes, Line* out, Line* x, Line* directions);

/// What the points of a block end with.
struct ContactResults {
  int points, tangents;
  int lanes;               ///< In use: the first ones.
  const Line* x;           ///< Of the normals of all points, then of the friction of each.
  const Line* directions;  ///< As ContactRowsKernel left them, if there is friction.
  /// A point every kStartStride numbers: those of a start impulse, then t1.
  float* to[kLanes] = {};
};

/// Writes the results of a block to where its lanes want them.
using ContactResultsKernel = void (*)(const ContactResults& results);

struct ContactKernels {
  ContactRowsKernel pack;
  ContactResultsKernel unpack;
};

/// @pre the CPU supports it
const ContactKernels& ContactKernelsFor(Target target);

}  // namespace cairn::simd
