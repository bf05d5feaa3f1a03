// SPDX-License-Identifier: MIT
#pragma once

#include "problems/problem.h"

namespace cairn::problems {

/// Elastic-plastic torsion of a square bar: the stress function u, |u| at most the distance to the
/// boundary of the unit square, that minimises integral of 1/2 |grad u|^2 - c u; c grows with the
/// twist. CUTEst's TORSION1 (c = 5), TORSION3 (10) and TORSION5 (20) of More and Toraldo, SIAM J.
/// Optim. 1 (1991). As there, the edges that end on the boundary count half.
Generator Torsion();

}  // namespace cairn::problems
