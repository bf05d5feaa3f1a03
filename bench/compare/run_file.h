// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace cairn::cli {

/// Values of each repetition and frame; NaN where a frame does not count.
using Repetitions = std::vector<std::vector<double>>;

/// A solver on a scene, as far as runs can be compared by it.
struct RecordedSolver {
  std::string name, effort;
  std::string failure;    ///< With its frame; empty if it did not fail.
  Repetitions times;      ///< [ms]
  Repetitions residuals;  ///< [m/s]
};

struct RecordedScene {
  std::string name;
  std::string world;               ///< Size, seed and bodies, in words.
  Repetitions arithmetic, memory;  ///< The metronome [ms].
  std::vector<RecordedSolver> solvers;
};

/// What must be the same, or should be, for two runs to be comparable: its name and value.
struct Circumstance {
  std::string name, value;
};

/// A file that `cairn run --json` wrote.
struct RunFile {
  std::string path;
  std::vector<Circumstance> required;  ///< Where these differ, a comparison says nothing.
  std::vector<Circumstance> expected;  ///< Where these differ, the user should know.
  std::vector<RecordedScene> scenes;
};

/// @throws Failure (kUsage) with the path and what is wrong with the file.
RunFile ReadRunFile(const std::string& path);

}  // namespace cairn::cli
