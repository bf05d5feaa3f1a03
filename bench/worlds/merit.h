// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/contact_problem.h"

namespace cairn::bench {

/// What impulses x are worth on the island where they are worth least, against none at all [J]:
///   phi(x) = 1/2 |M^-1/2 J' x|^2 + 1/2 x' E x - (target - J v_free)' x,
/// which every row lowers as far as its bounds let it. A result with phi(x) > 0 = phi(0) has put
/// energy in. Bodies with locked axes are left out of rows that leave them alone (docs/solver.md).
struct Audit {
  double merit = 0;  ///< phi(x) of that island.
  /// What rounding may make of it: kLeast, and kRounding of the energy that its impulses turn over,
  /// 1/2 |M^-1/2 J' x|^2 + 1/2 x' E x + |target - J v_free|' |x|.
  double tolerance = 0;
  static constexpr double kRounding = 1e-3;
  static constexpr double kLeast = 1e-6;  ///< [J] 1 kg at 1.4 mm/s

  bool violated() const { return !(merit <= tolerance); }
};

/// In double precision and from the problem alone, whichever solver made the impulses.
/// @param impulses  one per row
Audit AuditEnergy(const ContactProblem& problem, std::span<const double> impulses);

}  // namespace cairn::bench
