// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <Eigen/SparseCore>
#include <limits>

namespace cairn::lcp {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();  ///< No bound.

/// A boxed linear complementarity problem: find x, lo <= x <= hi, such that w = M x + q obeys, for
/// every row i,
///   w_i >= 0 where x_i = lo_i,   w_i <= 0 where x_i = hi_i,   w_i = 0 in between.
/// lo = -inf, hi = inf makes row i an equation (u of the mixed problem of [1]); lo = 0, hi = inf
/// makes it complementary (v). x minimises 1/2 x' M x + q' x inside the box. In a time step x are
/// impulses [N s] and w relative velocities [m/s].
///
/// [1] Morales, Nocedal, Smelyanskiy, "An algorithm for the fast solution of symmetric linear
///     complementarity problems", Numer. Math. 111 (2008) 251-266.
struct BoxedLcp {
  /// n x n, symmetric positive definite, both triangles stored. Semidefinite matrices are solved
  /// too, as long as the problem has a solution.
  Eigen::SparseMatrix<double> M;
  Eigen::VectorXd q;       ///< n, finite.
  Eigen::VectorXd lo, hi;  ///< n each, lo <= hi, infinities allowed.

  Eigen::Index size() const { return q.size(); }
};

/// The mixed linear complementarity problem in the letters of [1]: find u and v with
///   A u + C v + a = 0,   C' u + B v + b >= 0,   v >= 0,   v' (C' u + B v + b) = 0.
/// In a time step u are the impulses of joints, v those of contacts.
struct MixedLcp {
  /// n_a x n_a and n_b x n_b, both triangles stored, and n_a x n_b; [A C; C' B] symmetric positive
  /// definite. n_a or n_b may be 0.
  Eigen::SparseMatrix<double> A, B, C;
  Eigen::VectorXd a, b;  ///< n_a and n_b.
};

/// The same problem with x = (u, v) and bounds -inf <= u, 0 <= v. @pre its sizes agree
[[nodiscard]] BoxedLcp ToBoxed(const MixedLcp& problem);

/// How far x is from the solution. e_i = d_i |x_i - clamp(x_i - w_i / d_i, lo_i, hi_i)| with
/// d = diag(M) is the natural map in the unit of w.
struct LcpResidual {
  double max = 0;     ///< Largest e_i, unit of w.
  double energy = 0;  ///< sqrt(sum e_i^2 / d_i), square root of the unit of x w.
  /// energy / sqrt(sum q_i^2 / d_i): a pure number, the same however rows and units are scaled.
  /// What Settings::tolerance is held against. `energy` itself where q = 0.
  double relative = 0;
  /// |x - clamp(x - w, lo, hi)|_2 / |q|_2, the measure of Siconos' lcp_compute_error (absolute
  /// where q = 0). It changes with the scale of the rows.
  double natural = 0;
  double violation = 0;  ///< Largest distance of an x_i from its box, unit of x.
  /// sum of |w_i| times the distance of x_i to the bound that w_i pushes it against, unit of x w.
  /// Where there is no such bound, |w_i| times |w_i| / d_i.
  double complementarity = 0;
  double objective = 0;  ///< 1/2 x' M x + q' x, unit of x w.
};

/// Measures x from the problem alone, in double precision: the same measure for every solver.
/// @pre all sizes agree and every diagonal entry of M is positive: Validate() says so.
[[nodiscard]] LcpResidual Measure(const BoxedLcp& problem, const Eigen::VectorXd& x);

}  // namespace cairn::lcp
