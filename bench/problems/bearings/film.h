// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "problems/grid.h"

namespace cairn::problems {

/// The pressure p >= 0 of a lubricant film of thickness h(x) > 0 on a line, by Reynolds' equation
/// with cavitation:  -(h^3 p')' + h' >= 0,  p >= 0,  p (-(h^3 p')' + h') = 0,  p = 0 at both ends.
/// Finite volumes: what flows into a cell flows out of its neighbour, row i is the balance of cell
/// i, and the error of p falls with the square of the cell width.
/// @param line  ny = 1; row i is the pressure at line.x(i).
BoxedLcp FilmLcp(const Grid& line, const std::function<double(double x)>& h);

/// p = 0 at both ends and 0 <= p, for Prolong().
Box PressureBox();

}  // namespace cairn::problems
