// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "cairn/executor.h"

namespace cairn {

/// Threads of oneTBB, @p threads with the caller's. The only user of oneTBB.
std::unique_ptr<Executor> MakeTbbExecutor(int threads);

}  // namespace cairn
