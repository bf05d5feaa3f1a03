// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "problems/problem.h"
#include "rows/row_problem.h"

namespace cairn::cli {

/// Every problem that goes by a name, those that Bullet makes included.
const std::vector<problems::Generator>& KnownGenerators();

/// A problem of `cairn solve`.
struct ProblemChoice {
  /// Begins anew: a march is made by every solver for itself.
  std::function<std::unique_ptr<problems::Source>()> make;
  int size = 0;  ///< What the generator was given; 0 for a folder.
  /// Name and value of each parameter of the generator.
  std::vector<std::pair<std::string, double>> parameters;
};

/// A folder among others that is no problem for these solvers.
struct SkippedFolder {
  std::string name, reason;
};

/// A problem or recording in a folder of several that cannot be used.
struct UnreadFile {
  std::string path, reason;  ///< The reason names the file, too.
};

/// What was typed about problems.
struct ProblemWords {
  std::vector<std::string> names;     ///< Generators, folders of problems, recordings.
  std::string size;                   ///< --size; empty: the default of each generator.
  std::vector<std::string> settings;  ///< --set, each "name=value".
};

struct ProblemChoices {
  std::vector<ProblemChoice> problems;
  std::vector<std::shared_ptr<const RowProblem>> frames;  ///< Recordings.
  std::vector<SkippedFolder> skipped;
  std::vector<UnreadFile> unread;
};

/// Reads all folders and recordings, so that a broken one is found before anything is solved. One
/// among others of a folder becomes `unread`, and the others stay.
/// @throws Failure: kUsage for an unknown name, size or parameter, kBadInput for what was typed
/// itself and cannot be read, or whose numbers Validate() refuses.
ProblemChoices ParseProblems(const ProblemWords& words);

}  // namespace cairn::cli
