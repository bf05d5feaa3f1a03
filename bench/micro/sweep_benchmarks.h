// SPDX-License-Identifier: MIT
#pragma once

#include "micro/memory.h"

namespace cairn::micro {

/// Registers all benchmarks: what memory gives, passes of our kernels, and Bullet's sweeps over the
/// same rows. @p memory lives as long as they run.
void RegisterBenchmarks(const Memory& memory);

/// Puts into the report where and with what it was made, and what speaks against its figures.
void AddContext(const Memory& memory);

}  // namespace cairn::micro
