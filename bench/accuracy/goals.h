// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace cairn::accuracy {

/// What the velocity error with steps may be at most, as a share of that of Bullet's 10 iterations
/// in the same time. NaN for a scene without a goal.
double GoalOf(std::string_view scene);

}  // namespace cairn::accuracy
