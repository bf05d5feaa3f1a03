// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "block_pack.h"
#include "plan.h"

namespace cairn {

/// What all methods minimise while friction bounds stand still, of every island of a group [J]:
///   phi = |u|^2 / 2 + x' E x / 2 - target' x,
/// computed in double precision. phi less its least value is the energy of the velocity error, so
/// it also counts what residuals hardly see: error that is spread over a whole stack.
/// @p merits: one for each island of the plan; those of the group are written
void FindMerits(const Plan& plan, const Group& group, const BlockData& blocks,
                std::span<double> merits);

}  // namespace cairn
