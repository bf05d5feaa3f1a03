// SPDX-License-Identifier: MIT
// A problem as a folder: meta.json and Matrix Market files.
//
//   meta.json                name, kind, source; n, n_a; reference.unique_solution
//   matrix.mtx, q.mtx        M and q of w = M x + q
//   lower.mtx, upper.mtx     kind boxqp: bounds; a magnitude of 1e300 or more is infinite
//   solution.mtx, w.mtx      a known solution and its w, if there is one
//
// Kinds: lcp, all rows 0 <= x; mlcp, the first n_a rows free and the others 0 <= x; boxqp.
#pragma once

#include <filesystem>
#include <vector>

#include "problems/matrix_market.h"
#include "problems/problem.h"

namespace cairn::problems {

/// Bounds of at least this magnitude in a file are infinite.
inline constexpr double kFileInfinity = 1e300;

/// Whether the folder holds a meta.json.
bool IsProblemFolder(const std::filesystem::path& folder);

/// The problem folders directly inside, by name.
std::vector<std::filesystem::path> ProblemFoldersIn(const std::filesystem::path& folder);

/// `kind` of meta.json: "lcp", "mlcp", "boxqp", or "friction", which is no boxed LCP.
/// @throws FileError
std::string ReadKind(const std::filesystem::path& folder);

/// Reads a whole problem. `solution` is left empty where meta.json does not say that x is unique,
/// `slack` and `solution` where it says that they were not verified.
/// @throws FileError for anything missing, malformed or of another size than the rest, and for kind
/// friction, whose bounds follow other unknowns. Numbers are not judged: see Validate().
Problem ReadProblemFolder(const std::filesystem::path& folder);

/// Writes the lcp, solution and slack of a problem, of the first kind that fits. Makes the folder.
/// @throws FileError
void WriteProblemFolder(const std::filesystem::path& folder, const Problem& problem);

}  // namespace cairn::problems
