// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <algorithm>

namespace cairn {

/// What impulses of the last step are multiplied by to begin one of another length: what holds a
/// load does it with a force. At most 10, as what stops a blow in a short step does not go on.
inline double ShareOfStart(double last_time_step, double time_step) {
  if (!(last_time_step > 0 && time_step > 0)) return 1;
  return std::min(10.0, time_step / last_time_step);
}

}  // namespace cairn
