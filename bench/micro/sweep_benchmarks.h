// SPDX-License-Identifier: MIT
#pragma once

#include "micro/memory.h"

namespace cairn::micro {

/// Registers all benchmarks: what memory gives, passes of our kernels, and Bullet's sweeps over the
/// same rows. @p memory lives as long as they run.
void RegisterBenchmarks(const Memory& memory);

}  // namespace cairn::micro
