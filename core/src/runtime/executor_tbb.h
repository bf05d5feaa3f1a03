// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "cairn/executor.h"

namespace cairn {

/// As many as oneTBB will ever run at a time, the caller's included. More would only be refused,
/// and it complains about that on stderr.
int MostTbbThreads();

/// Threads of oneTBB, @p threads with the caller's. The only user of oneTBB.
std::unique_ptr<Executor> MakeTbbExecutor(int threads);

}  // namespace cairn
