// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/contact_problem.h"
#include "cairn/detail/threads.h"
#include "cairn/report.h"

namespace cairn {

/// Fills Report::depth, gap and angle.
/// @param velocities  that bodies move by over the step
/// @pre the problem was solved
void TellCorrections(const ContactProblem& problem, std::span<const Velocity> velocities,
                     detail::Threads* threads, Report* report);

}  // namespace cairn
