// SPDX-License-Identifier: MIT
#pragma once

namespace cairn {

/// The natural logarithm, from operations that are the same to the bit with every compiler and C
/// library: what decides whether a step pays must not depend on either. Within 3 units of the last
/// place; -infinity for 0, NaN for less.
double Log(double x);

/// e^x - 1 likewise, accurate for small x, too. -1 far below 0, infinity far above.
double ExpMinusOne(double x);

}  // namespace cairn
