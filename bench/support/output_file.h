// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace cairn::cli {

/// @throws Failure (kBadInput) if the file cannot be written; asked before a long run, so that its
/// results are not lost after it. Leaves an existing file as it is.
void CheckWritable(const std::string& path);

/// All of it or nothing, see WriteWholeFile(). @throws Failure (kBadInput) with the path.
void WriteFile(const std::string& path, const std::string& text);

/// @throws Failure (kBadInput) if something that was printed to stdout did not get there.
void FinishOutput();

}  // namespace cairn::cli
