// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "cairn/executor.h"

namespace cairn {

/// As many threads as the library's own Executor will ever run at a time, the caller's included:
/// those of oneTBB, which complains on stderr where more are asked for, or of std::thread where it
/// was built without.
int MostOwnThreads();

/// @p threads with the caller's. See executor_tbb.cc and executor_threads.cc.
std::unique_ptr<Executor> MakeOwnExecutor(int threads);

}  // namespace cairn
