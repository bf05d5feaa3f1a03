// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "run/result.h"

namespace cairn::cli {

/// The timelines of a run in the trace event format of Chrome, which ui.perfetto.dev and
/// chrome://tracing open: a process for each solver and scene, a thread for each worker.
std::string ToTrace(const RunResult& run);

}  // namespace cairn::cli
