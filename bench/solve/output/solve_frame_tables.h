// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "solve/solve_result.h"
#include "support/text_table.h"

namespace cairn::cli {

/// What a recorded frame is, and what its errors are against.
std::string FrameHeading(const ProblemResult& problem);

/// A row for each recorded frame and solver: time, work, residual, error and why it ended.
TextTable FrameWorkTable(const SolveResult& result);
/// The first time at which errors of velocities and residuals were small enough.
TextTable FrameLevelTable(const SolveResult& result);
/// Errors of velocities after given times, and residuals.
TextTable FrameErrorTable(const SolveResult& result);
TextTable FrameResidualTable(const SolveResult& result);

/// How to read them.
std::string FrameReadingHelp(const SolveResult& result);

/// Times at which errors are given [ms], up to the longest of a result.
std::vector<double> TimesOfErrors(const SolveResult& result);

/// The last point of a curve that was reached in `time` [ms]; nullptr if there is none.
const HistoryPoint* PointAt(const LcpSolverResult& solver, double time);

}  // namespace cairn::cli
