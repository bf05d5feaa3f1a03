// SPDX-License-Identifier: MIT
#pragma once

#include "problems/problem.h"

namespace cairn::problems {

/// A membrane over a ball: the u of least energy with u >= psi on (-2, 2)^2, psi = sqrt(1 - r^2)
/// inside r = 0.9 and its tangent cone outside. u is known everywhere: PETSc's SNES tutorial ex9.
/// The matrix is that of the 5-point formula times the square of the mesh width: 4 and -1.
/// A problem takes 88 bytes a point: 64 for M, 24 for q and the bounds. While it is made, M is
/// there up to three times, since Eigen 3.4 copies where it should move: 205 MiB for 1000 x 1000
/// points.
Generator Obstacle();

/// A membrane between two obstacles on the unit square under a load c, u = 0 around: Dembo and
/// Tulowitzki 1983 as in CUTEst. OBSTCLB, between s^3 and s^2 + 0.02 with s = sin(9.2 x) sin(9.3
/// y); or OBSTCLA, above sin(3.2 x) sin(3.3 y) and below 2000. As there, the edges that end on the
/// boundary count half.
Generator TwoSidedObstacle();

}  // namespace cairn::problems
