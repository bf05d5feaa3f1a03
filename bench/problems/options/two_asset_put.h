// SPDX-License-Identifier: MIT
#pragma once

#include "problems/problem.h"

namespace cairn::problems {

/// "put-on-min": the march of a put on the cheaper of two assets.
Generator PutOnMin();

/// "put-on-average": the same on their average.
Generator PutOnAverage();

/// "put-on-min-step": one step in the middle of the first march, with its solution.
Generator PutOnMinStep();

}  // namespace cairn::problems
