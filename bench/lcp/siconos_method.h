// SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace cairn::cli {

/// How a solver of Siconos wants its matrix.
enum class SiconosStorage {
  kDense,         ///< Column by column, zeros included.
  kSparse,        ///< Compressed columns.
  kSparseBlocks,  ///< Blocks of one entry.
};

/// What stops a solver of Siconos.
enum class SiconosStop {
  kRelative,  ///< |z - max(z - w, 0)| / |q| at most its tolerance.
  kAbsolute,  ///< |z - max(z - w, 0)| at most its tolerance.
  kEnd,       ///< The last pivot; it takes no tolerance.
};

/// A solver of Siconos Numerics 4.4 for linear complementarity problems, and what is known of it.
struct SiconosMethod {
  const char* name;         ///< "siconos-pgs"
  const char* description;  ///< One line.
  int id;                   ///< SICONOS_LCP_... of lcp_cst.h
  SiconosStorage storage;
  SiconosStop stop;
  /// Most that it holds at once, as dense n x n matrices, our own included: what counts against
  /// kSiconosMemory. 0 for sparse storage.
  int matrices;
  /// Iterations at most, unless the user says otherwise: this many, times n for pivots.
  int max_iterations;
};

/// A dense problem that needs more is refused [byte]: Siconos does not check what malloc returns.
inline constexpr double kSiconosMemory = 2.0 * (1 << 30);

std::span<const SiconosMethod> SiconosMethods();

}  // namespace cairn::cli
