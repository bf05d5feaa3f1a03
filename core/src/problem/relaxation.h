// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/settings.h"

namespace cairn {

/// Step length of every row: over-relaxation of Method::kPsor.
inline double OmegaOf(const Settings& settings) {
  return settings.method == Method::kPsor ? settings.tuning.omega : 1.0;
}

}  // namespace cairn
