// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/report.h"
#include "reference/pack.h"

namespace cairn {

/// Natural residual of the present state; see Residual.
Residual MeasureResidual(const PackedIsland& island, const IslandState& state);

/// Adds the residual of one island to that of many.
void Accumulate(const Residual& part, Report* report);

}  // namespace cairn
