// SPDX-License-Identifier: MIT
#pragma once

#include "problems/problem.h"

namespace cairn::problems {

/// The plane slider, -(h^3 p')' + h' >= 0, p >= 0 on (0, 1) with the wedge h = 1 + k (1 - x): its
/// pressure p = k x (1 - x) / ((2 + k) h^2) is positive everywhere, so that no bound is active.
/// Waves on it, h + a sin(2 pi m x), cavitate where they open too fast; then nothing is known.
Generator Slider();

}  // namespace cairn::problems
