// SPDX-License-Identifier: MIT
#pragma once

#include "problems/problem.h"

namespace cairn::problems {

/// "american-put": the march of an American put on one asset.
Generator AmericanPut();

/// "american-put-step": one step in the middle of such a march, with its solution.
Generator AmericanPutStep();

}  // namespace cairn::problems
