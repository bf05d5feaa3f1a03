// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <cstdint>

#include "cairn/detail/host.h"

namespace cairn {

/// A row of a joint: a cache line. Its fields mean what those of a Row do, but for the target:
///   w = J (v - v_free) + compliance x - (target - damping J v_free),
/// where v_free is how the bodies move without constraints (ContactProblem::motions, if given).
struct JointRow {
  float linear_a[3] = {};   ///< Of J; what belongs to kWorld is finite, and does nothing.
  float target = 0;         ///< [m/s] or [rad/s]
  float angular_a[3] = {};  ///< Likewise.
  float compliance = 0;     ///< E [1/kg], >= 0; read if Joint::soft.
  float linear_b[3] = {};
  float lo = -kInfinity;  ///< [N s] or [N m s], <= hi; read where Joint::bounded says so.
  float angular_b[3] = {};
  float hi = kInfinity;  ///< Likewise.
};

/// What connects two bodies, at most one of which is kWorld.
struct Joint {
  static constexpr int kMostRows = 32;

  int body_a = kWorld, body_b = kWorld;
  int first_row = 0;          ///< In ContactProblem::joint_rows.
  int rows = 1;               ///< In [1, kMostRows].
  std::uint32_t bounded = 0;  ///< Bit i: row i has bounds, 0 for none.
  std::uint32_t angular = 0;  ///< Bit i: row i only turns, and counts in [rad/s].
  std::uint32_t errors = 0;   ///< Bit i: the target of row i takes back an error of position.
  float damping = 1;      ///< Share of the free motion of bodies that rows work against; 1: all.
  bool soft = false;      ///< Rows have a compliance.
  bool opposite = false;  ///< linear_b is -linear_a, whatever it says: rows are swept faster.
  detail::RowHost host = {};

  bool is_bounded(int row) const { return (bounded >> row & 1) != 0; }
  bool is_angular(int row) const { return (angular >> row & 1) != 0; }
};

}  // namespace cairn
