// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/contact_problem.h"
#include "cairn/report.h"

namespace cairn {

// What a report says of a whole, from what is known of its parts.

/// Forgets what it says, and keeps its memory.
void ForgetReport(Report* report);
/// Report::bad_row and its like, from one who looked.
void CopyJudgement(const Report& checked, Report* report);
/// Adds what was done in a part of a step, whose islands are those of the part before unless the
/// first part is added. What is said of the state of an island is of the last.
void Add(const Report& part, Report* sum);
/// Adds up what was done on the islands.
void SumUp(Report* report);
/// Says which bodies are strained most, and what would help. @p substeps: those of the bodies
void TellStrains(std::span<const Body> bodies, int substeps, Report* report);

}  // namespace cairn
