// SPDX-License-Identifier: MIT
#pragma once

#include <ctime>

namespace cairn::micro {

/// Time that this program, of one thread, has had a CPU for. Counts microseconds.
inline double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace cairn::micro
