// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

namespace cairn::cli {

/// @throws Failure (kBadInput) if the file cannot be written; asked before a long run, so that its
/// results are not lost after it. Leaves an existing file as it is.
void CheckWritable(const std::string& path);

/// The same of all that are not empty. @throws Failure (kUsage) if two are the same file, of which
/// only the last would be left.
void CheckWritable(std::span<const std::string> paths);

/// Makes the folder, if need be. @throws Failure (kBadInput) if nothing can be written there; asked
/// before a long run.
void CheckFolder(const std::string& folder);

/// All of it or nothing, see WriteWholeFile(). @throws Failure (kBadInput) with the path.
void WriteFile(const std::string& path, const std::string& text);

/// A file that a result is written to, in a form of its own; none without a path.
template <class Result>
struct ResultFile {
  std::string path;
  std::string (*format)(const Result&);
};

template <class Result>
void CheckWritable(const std::vector<ResultFile<Result>>& files) {
  std::vector<std::string> paths;
  for (const ResultFile<Result>& file : files) paths.push_back(file.path);
  CheckWritable(paths);
}

template <class Result>
void WriteFiles(const std::vector<ResultFile<Result>>& files, const Result& result) {
  for (const ResultFile<Result>& file : files) {
    if (!file.path.empty()) WriteFile(file.path, file.format(result));
  }
}

/// @throws Failure (kBadInput) if something that was printed to stdout did not get there.
void FinishOutput();

}  // namespace cairn::cli
