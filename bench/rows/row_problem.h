// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "cairn/detail/recording.h"

namespace cairn::cli {

/// A recorded frame as the solvers of `cairn solve` are given it. Every row may be swept as often
/// as a solver likes: a game without a budget bounds that by its iterations, and the frame would
/// stop after these, whatever the budget here.
struct RowProblem {
  std::string name;  ///< Of the file, without its ending.
  std::string source;
  Recording frame;         ///< As it was made, contacts in manifolds.
  Recording rows;          ///< The same with contacts written out, behind those it has.
  int first_contact = 0;   ///< Of the rows that are written out.
  int limited_sweeps = 0;  ///< The fewest sweeps that a row was limited to; 0: none was.
};

/// Whether a file begins as a recording does.
bool IsRecording(const std::string& path);

/// @throws Failure (kBadInput) if it cannot be read, or holds what no solver takes
std::shared_ptr<const RowProblem> LoadRowProblem(const std::string& path);

/// The same problem, started from nothing.
RowProblem FromZero(const RowProblem& problem);

}  // namespace cairn::cli
