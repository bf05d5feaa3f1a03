// SPDX-License-Identifier: MIT
#pragma once

#include "simd/pairs/pair_block.h"
#include "simd/rows/contact_body.h"
#include "simd/target.h"

namespace cairn::simd {

/// Numbers of a row of a joint, in this order; see JointRow.
enum JointNumber {
  kLinearA = 0,
  kTarget = 3,
  kAngularA = 4,
  kRowCompliance = 7,
  kLinearB = 8,
  kLo = 11,
  kAngularB = 12,
  kHi = 15,
  kJointNumbers
};

/// The joints of a block. Others than the first lanes are not looked at.
struct JointLanes {
  PairForm form;
  const RowShape* rows;
  int row_count;
  int lanes;  ///< In use: the first ones, a multiple of four.
  const ContactBody* a[kLanes] = {};
  const ContactBody* b[kLanes] = {};
  /// The movable one of a PairForm::kSingle is b.
  bool second_moves[kLanes] = {};
  bool opposite[kLanes] = {};  ///< rows are: their linear_b is not looked at
  float damping[kLanes] = {};
  const float* row[kLanes] = {};    ///< kJointNumbers numbers a row, one after the other
  const float* start[kLanes] = {};  ///< one number a row
};

/// Writes the lines of the rows. @p x: start impulses, one line a row, inside their bounds. False
/// if a number is not finite or does not fit a float with its square, or if bounds are not in
/// order. Same bits on every target.
using JointRowsKernel = bool (*)(const JointLanes& lanes, Line* out, Line* x);

/// @pre the CPU supports it
JointRowsKernel JointRowsKernelFor(Target target);

}  // namespace cairn::simd
