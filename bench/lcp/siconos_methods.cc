// SPDX-License-Identifier: MIT
#include <vector>

#include "lcp/siconos_method.h"

namespace cairn::cli {

// Found by running every solver of lcp_cst.h of Siconos 4.4.0, as Debian 12 builds it, on sparse
// and on dense matrices. PGS and the projected gradient are all that take sparse ones; the others
// read the dense array without asking. Not here, since they do not work in that build or not for
// us:
//   QP, NSQP, GAMS  abort, and PATH returns at once: their back ends are not free and not built in
//   PATHSEARCH      "for testing purposes only", and found no solution
//   BARD            had not ended after 5 s at n = 376, where Lemke needs 0.03 s
//   ENUM            tries 2^n bases
//   AVI_CAOFERRIS   the pivots of PIVOT, in the same time
// The numbers are those of lcp_cst.h, so that this list is there without Siconos too;
// siconos_call.cc compares them.
std::span<const SiconosMethod> SiconosMethods() {
  using enum SiconosStorage;
  using enum SiconosStop;
  // As many sweeps as Cairn's own, and for Newton's methods Siconos' default.
  constexpr int kSweeps = 50000, kNewtonSteps = 1000, kPivotsPerRow = 10;
  static const std::vector<SiconosMethod> methods = {
      {"siconos-pgs", "Siconos: projected Gauss-Seidel, sparse", 202, kSparse, kRelative, 0,
       kSweeps},
      {"siconos-gradient", "Siconos: projected gradient with line search, sparse", 222, kSparse,
       kRelative, 0, kSweeps},
      {"siconos-nsgs", "Siconos: Gauss-Seidel over sparse blocks of one row", 201, kSparseBlocks,
       kRelative, 0, kSweeps},
      {"siconos-psor", "Siconos: projected SOR, whose factor it ignores, dense", 210, kDense,
       kRelative, 1, kSweeps},
      {"siconos-rpgs", "Siconos: regularised projected Gauss-Seidel, dense", 211, kDense, kRelative,
       1, kSweeps},
      {"siconos-cpg", "Siconos: conjugate projected gradient, dense", 203, kDense, kRelative, 1,
       kSweeps},
      {"siconos-latin", "Siconos: large time increments, dense", 204, kDense, kAbsolute, 4,
       kSweeps},
      {"siconos-latin-w", "Siconos: the same with relaxation, dense", 205, kDense, kAbsolute, 4,
       kSweeps},
      {"siconos-newton-min", "Siconos: Newton for the minimum map, dense of 2n rows", 208, kDense,
       kRelative, 9, kNewtonSteps},
      {"siconos-newton-fb", "Siconos: Newton for Fischer-Burmeister, dense", 209, kDense, kRelative,
       4, kNewtonSteps},
      {"siconos-newton-min-fb", "Siconos: Newton, minimum map guarded by Fischer-Burmeister, dense",
       218, kDense, kRelative, 4, kNewtonSteps},
      {"siconos-lemke", "Siconos: lexicographic Lemke, dense", 200, kDense, kEnd, 3, kPivotsPerRow},
      {"siconos-pivot", "Siconos: Lemke's pivots, driftless, dense", 215, kDense, kEnd, 3,
       kPivotsPerRow},
      {"siconos-pivot-lumod", "Siconos: the same with updates of LU factors, dense", 220, kDense,
       kEnd, 8, kPivotsPerRow},
      {"siconos-murty", "Siconos: Murty's least index pivots, dense", 217, kDense, kEnd, 2,
       kPivotsPerRow},
  };
  return methods;
}

}  // namespace cairn::cli
