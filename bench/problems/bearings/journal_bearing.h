// SPDX-License-Identifier: MIT
#pragma once

#include "problems/problem.h"

namespace cairn::problems {

/// The pressure p >= 0 in a journal bearing of finite length: minimise
///   integral of 1/2 (1 + e cos x)^3 |grad p|^2 - e sin(x) p   over (0, 2 pi) x (0, 20), p = 0
///   around,
/// in linear finite elements on halved rectangles, as MINPACK-2's dpjbfg (Averick et al., "The
/// MINPACK-2 test problem collection", 1992, b = 10) and CUTEst's JNLBRNG1 and JNLBRNG2.
Generator JournalBearing();

/// That problem on nx points around and ny along the bearing, without its boundary. CUTEst's PT and
/// PY count the boundary: nx = PT - 2.
Problem MakeJournalBearing(int nx, int ny, double eccentricity);

}  // namespace cairn::problems
